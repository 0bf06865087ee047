#pragma once

#include "lbm/fluid.hpp"

#include "domain/faces.hpp"
#include "fields/films.hpp"
#include "fields/sweep.hpp"
#include "lattice/units.hpp"
#include "physics/load_ledger.hpp"

#include <omp.h>

#include <algorithm>
#include <new>
#include <unordered_map>
#include <variant>

namespace lbm {

inline constexpr double kSpeedOfSound = 0.57735026918962576451;  // 1 / sqrt(3), lattice units

/// With fewer cells for each of them threads wait for each other longer than they compute (two in 16^3 cells were 15 % slower than one), on a busy machine a
/// hundred times as long.
inline constexpr double kFewestCellsOfThread = 4096;

/// Runs the loops below with the number of threads that the configuration asks for, as far as they have enough to do.
class ThreadCount {
public:
    explicit ThreadCount(const FluidConfig& c) : before_(omp_get_max_threads())
    {
        const double useful = double(c.cells[0]) * c.cells[1] * c.cells[2] / kFewestCellsOfThread;
        const int asked = c.threads > 0 ? c.threads : before_;
        omp_set_num_threads(useful < asked ? std::max(1, static_cast<int>(useful)) : asked);
    }
    ~ThreadCount() { omp_set_num_threads(before_); }
    ThreadCount(const ThreadCount&) = delete;
    ThreadCount& operator=(const ThreadCount&) = delete;

private:
    int before_;
};

using AnyPopulations = std::variant<Populations<D3Q19, double>, Populations<D3Q19, float>, Populations<D3Q27, double>,
                                    Populations<D3Q27, float>>;

struct Fluid::Implementation {
    FluidConfig config;
    double dt;
    Units units;
    CollisionParameters collision;
    AnyPopulations populations;
    Faces faces;
    SolidMap map;
    Films films;
    std::int64_t steps = 0, steps_before_dt = 0;  // the latter when dt became what it is
    double time_before_dt = 0;

    std::vector<Solid> solids;                 // as last placed
    std::vector<LatticeSolid> lattice_solids;  // while placing, and their indices before, or -1
    std::vector<int> previous;
    std::vector<LoadLedger> ledgers;  // in the same order
    struct Motion {
        Vec3 velocity, angular_velocity;
        double share, spin_share;  ///< of the load that was passed on (LoadLedger)
    };
    /// Momentum in lattice units, with its moment.
    struct Carried {
        Vec3 momentum{}, moment{};
    };
    std::vector<double>
        volumes_before;  // inside the box, of the solids where they were placed before; in the same order
    std::vector<Carried>
        carried_in;  // with what fills them, through open faces, on the way to where they are placed; moments about their centres
    std::array<Carried, 6> carried_by_face;             // the same by face; moments about the origin of the lattice
    bool placed = false;                                // since the last step
    std::vector<Motion> last_motions;                   // of the solids in the last step; in the same order
    std::unordered_map<std::int64_t, int> index_of_id;  // into all of them
    std::vector<SolidLoad> loads;
    std::vector<FilmSphere> film_spheres;
    std::vector<SolidLoad> loads_of_films;  // in the last step of the films, SI; its order may be another
    std::array<Vec3, 6> film_forces_on_walls{};
    double max_speed2 = 0;
    StepTimes times;

    explicit Implementation(const FluidConfig& c);

    std::size_t memory_bytes() const;
    /**
     * Changes the fluid. Where memory runs out in the middle of it nobody may use it any more.
     * @param asked  what the memory was asked for, in the message
     */
    template <class Change>
    void change(const char* asked, Change make)
    {
        try {
            make();
        } catch (const std::bad_alloc&) {
            throw_out_of_memory(asked);
        }
    }
    [[noreturn]] void throw_out_of_memory(const char* asked) const;

    void start_at(double drho, const Vec3& u);
    /// sum f c of a cell where u = 0: half of the drive short
    Vec3 momentum_at_rest() const
    {
        const auto& F = collision.body_force;
        return {-0.5 * F[0], -0.5 * F[1], -0.5 * F[2]};
    }
    void place(const std::vector<Solid>& now);
    void carry_through_faces();
    void forget_carried();
    void carry_through_faces(std::size_t s);
    /// From one place of a solid to the next, to the nearest image [m].
    Vec3 way(const Solid& before, const Solid& now) const;
    /// Whether a solid goes on being what it was; one that jumped by more than its radius is another one.
    bool is_same(const Solid& now, const Solid& before) const;
    void step(int count);
    bool loads_can_wait() const;
    void change_tau(double tau);
    void change_faces(const std::array<FaceCondition, 6>& to);
    void rebuild_faces(double dynamic_pressure_scale);
    double time() const { return time_before_dt + static_cast<double>(steps - steps_before_dt) * dt; }
    void make_step(bool heard);
    void settle_loads();
    const std::vector<SolidLoad>& film_loads(const std::vector<Solid>& now, double step);
    /// B and B_w of a solid, or of the rigid body that it is part of.
    struct Coupling {
        double translation = 0, spin = 0;
    };
    /// Of the rigid bodies, by their numbers.
    std::unordered_map<std::int64_t, Coupling> couplings_of_bodies() const;
    SolidLoad load_in_si(std::size_t s, const LoadLedger::Load& load, const SolidSums& sums) const;
    void watch(const FlowWatch& flow) const;
    void watch_surfaces() const;
    Vec3 centre_in_box(const Solid& solid) const;  ///< [cells]
    LatticeSolid in_lattice_units(const Solid& solid) const;
    Solid in_mid_step(const Solid& solid, const Motion& last) const;

    void for_cells(const SeeCell& see) const
    {
        const ThreadCount threads(config);
        std::visit([&](const auto& f) { lbm::for_cells(f, collision, config.inertia, map, see); }, populations);
    }

    /// Sum over all cells of value(CellState), row by row, so that it does not depend on the number of threads.
    template <class Value, class Evaluate>
    Value sum_cells(Evaluate evaluate) const
    {
        std::vector<Value> rows(static_cast<std::size_t>(config.cells[1]) * config.cells[2], Value{});
        for_cells([&](const CellState& cell) { rows[index(cell) / config.cells[0]] += evaluate(cell); });
        Value sum{};
        for (const Value& row : rows) sum += row;
        return sum;
    }
    /// Of a cell in a field (nz, ny, nx).
    std::size_t index(const CellState& cell) const
    {
        return (static_cast<std::size_t>(cell.z) * config.cells[1] + cell.y) * config.cells[0] + cell.x;
    }
    /// What passes through the faces, in lattice units.
    std::array<Faces::Passage, 6> passages() const;
    CellState cell_at(int x, int y, int z) const;
    double cell_count() const { return double(config.cells[0]) * config.cells[1] * config.cells[2]; }
};

}  // namespace lbm
