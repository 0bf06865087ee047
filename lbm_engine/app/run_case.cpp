#include "run_case.hpp"

#include "rigid_body.hpp"

#include "lbm/overlap.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <system_error>

namespace lbm {
namespace {

constexpr std::int64_t kSmallestWindow = 200, kStepsOfReport = 16;

double size(const Vec3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
double distance(const Vec3& a, const Vec3& b) { return size({a[0] - b[0], a[1] - b[1], a[2] - b[2]}); }

std::int64_t window(const FluidConfig& c)
{
    const double L = *std::max_element(c.cells.begin(), c.cells.end());
    const double nu = (c.tau - 0.5) / 3;
    return std::max(kSmallestWindow,
                    static_cast<std::int64_t>(0.1 * L * L / (std::numbers::pi * std::numbers::pi * nu)));
}

/// What must stand still in a steady run.
struct Snapshot {
    Vec3 velocity;
    std::vector<SolidLoad> loads;
};

/// Sizes below which a quantity counts as zero by symmetry: this part of what the fastest fluid would give.
constexpr double kNegligible = 1e-3;

/// Largest change relative to the size of the quantity.
double change(const Snapshot& before, const Snapshot& now, double fastest, double viscosity,
              const std::vector<double>& radius)
{
    const auto relative = [](double difference, double scale) {
        return difference == 0 ? 0 : scale > 0 ? difference / scale : std::numeric_limits<double>::infinity();
    };
    double largest =
        relative(distance(before.velocity, now.velocity), std::max(size(now.velocity), kNegligible * fastest));
    for (std::size_t s = 0; s < now.loads.size(); ++s) {
        const SolidLoad &a = before.loads[s], &b = now.loads[s];
        const double R = radius[s], stokes = 6 * std::numbers::pi * viscosity * R * fastest;
        const double force = std::max(size(b.force), kNegligible * stokes);
        const double torque = std::max({size(b.torque), force * R, kNegligible * stokes * R});
        largest = std::max(
            {largest, relative(distance(a.force, b.force), force), relative(distance(a.torque, b.torque), torque)});
    }
    return largest;
}

/// Moves the solids of a case from step to step.
class Motion {
public:
    Motion(const Case& input, double dt) : dt_(dt), gravity_(input.fluid.gravity)
    {
        std::map<std::int64_t, std::vector<RigidBodyPart>> bodies;  // the free ones; negative numbers for single solids
        for (std::size_t s = 0; s < input.solids.size(); ++s) {
            const CaseSolid& entry = input.solids[s];
            solids_.push_back(entry.solid);
            if (entry.moving) moving_.push_back(s);
            if (!entry.free) continue;
            const std::int64_t body = entry.solid.body >= 0 ? entry.solid.body : -1 - static_cast<std::int64_t>(s);
            bodies[body].push_back({s, entry.density});
        }
        for (auto& [body, parts] : bodies) bodies_.emplace_back(std::move(parts), solids_);
    }
    const std::vector<Solid>& solids() const noexcept { return solids_; }
    bool is_still() const noexcept { return moving_.empty() && bodies_.empty(); }
    /// Semi-implicit Euler: velocities with the loads and weight, then those of the films, which need these, then positions.
    /// @return loads and films together
    const std::vector<SolidLoad>& advance(Fluid& fluid)
    {
        loads_ = fluid.loads();
        for (RigidBody& body : bodies_) body.push(loads_, gravity_, dt_, solids_);
        const auto& films = fluid.film_loads(solids_, dt_);
        for (RigidBody& body : bodies_) {
            body.push(films, {}, dt_, solids_);
            body.move(dt_, solids_);
        }
        for (const std::size_t s : moving_)
            for (int d = 0; d < 3; ++d) solids_[s].position[d] += dt_ * solids_[s].velocity[d];
        for (std::size_t s = 0; s < solids_.size(); ++s)
            for (int d = 0; d < 3; ++d) {
                loads_[s].force[d] += films[s].force[d];
                loads_[s].torque[d] += films[s].torque[d];
                for (int e = 0; e < 3; ++e) loads_[s].stresslet[d][e] += films[s].stresslet[d][e];
            }
        return loads_;
    }

private:
    std::vector<Solid> solids_;
    std::vector<std::size_t> moving_;
    std::vector<RigidBody> bodies_;
    std::vector<SolidLoad> loads_;
    double dt_;
    Vec3 gravity_;
};

/// Writes the state for the user to look at; a file that cannot be written must not hide why the run stopped.
std::string kept_state(const Fluid& fluid, const std::string& vtk)
{
    if (vtk.empty()) return "";
    try {
        fluid.save_vtk(vtk);
        return "; the state is in " + vtk;
    } catch (const RunError& error) {
        return std::string("; the state is not kept: ") + error.what();
    }
}

/// Before a long run; leaves nothing behind.
void require_writable(const std::string& vtk)
{
    if (vtk.empty()) return;
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(vtk, unknown);
    if (!std::ofstream(vtk, std::ios::app))
        throw ConfigError("output.vtk: " + vtk + " cannot be written; check its folder");
    if (!is_there) std::filesystem::remove(vtk, unknown);
}

void warn_of_overlaps(const FluidConfig& c, const std::vector<Solid>& solids,
                      const std::function<void(const std::string&)>& warn)
{
    const Overlaps found = overlaps(c, solids);
    if (found.pairs == 0) return;
    char shared[16];
    std::snprintf(shared, sizeof shared, "%.3g", 100 * found.shared);
    warn("solids[" + std::to_string(found.one) + "] and solids[" + std::to_string(found.other) + "] share " + shared +
         " % of the smaller one's volume, the most of " + std::to_string(found.pairs) +
         " overlapping pairs that are not one body: it counts twice, in buoyancy and in the resistance to the flow; "
         "give both the same \"body\"");
}

}  // namespace

CaseResult run_case(const Case& input, const std::function<void(const Progress&)>& report,
                    const std::function<void(const std::string&)>& warn)
{
    require_writable(input.vtk);
    Fluid fluid(input.fluid);
    Motion motion(input, fluid.dt());
    fluid.place_solids(motion.solids());
    warn_of_overlaps(input.fluid, motion.solids(), warn);
    const double mass = fluid.total_mass();
    const std::int64_t steps_between = window(input.fluid);

    std::vector<SolidLoad> loads = fluid.loads();
    const auto snapshot = [&] { return Snapshot{fluid.average_velocity(), loads}; };
    std::vector<double> radius;
    for (const Solid& s : motion.solids()) radius.push_back(s.shape == Shape::box ? size(s.half_extents) : s.radius);
    Snapshot before = snapshot();
    double latest_change = std::numeric_limits<double>::infinity();
    bool converged = false;
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };

    // Solids that stay where they are need to be looked at when somebody asks only.
    const auto steps_at_once = [&] {
        if (!motion.is_still()) return 1;
        const std::int64_t steps = fluid.steps(), left = input.max_steps - steps,
                           to_report = kStepsOfReport - steps % kStepsOfReport,
                           to_window = input.steady > 0 ? steps_between - steps % steps_between : left;
        return static_cast<int>(std::min({left, to_report, to_window}));
    };

    while (fluid.steps() < input.max_steps && !converged) {
        try {
            fluid.step(steps_at_once());
        } catch (const RunError& error) {
            throw RunError(error.what() + kept_state(fluid, input.vtk));
        }
        loads = motion.advance(fluid);
        fluid.place_solids(motion.solids());
        if (input.steady > 0 && fluid.steps() % steps_between == 0) {
            Snapshot now = snapshot();
            // A fluid that a drive cannot move is at rest but for round-off: what the drive would do in a pore of some cells is its size.
            const double in_a_pore = size(input.fluid.acceleration) * input.fluid.density * input.fluid.dx *
                                     input.fluid.dx / input.fluid.viscosity;
            const double fastest =
                std::max(in_a_pore, fluid.max_mach() / std::numbers::sqrt3 * input.fluid.dx / fluid.dt());
            latest_change = change(before, now, fastest, input.fluid.viscosity, radius);
            converged = latest_change < input.steady;
            before = std::move(now);
        }
        if (fluid.steps() % kStepsOfReport == 0) report({fluid.steps(), input.max_steps, seconds(), latest_change});
    }
    const double elapsed = seconds();
    std::string not_written;
    try {
        if (!input.vtk.empty()) fluid.save_vtk(input.vtk);
    } catch (const RunError& error) {
        not_written = error.what();
    }

    nlohmann::json json;
    json["steps"] = fluid.steps();
    json["converged"] = converged;
    json["tau"] = input.fluid.tau;
    json["lattice"] = input.fluid.lattice == Lattice::d3q27 ? "D3Q27" : "D3Q19";
    json["dt"] = fluid.dt();
    json["time"] = fluid.time();
    json["superficial_velocity"] = fluid.average_velocity();
    json["solids"] = nlohmann::json::array();
    for (std::size_t s = 0; s < motion.solids().size(); ++s) {
        const Solid& solid = motion.solids()[s];
        const SolidLoad& load = loads[s];
        json["solids"].push_back({{"force", load.force},
                                  {"torque", load.torque},
                                  {"stresslet", load.stresslet},
                                  {"position", solid.position},
                                  {"orientation", solid.orientation},
                                  {"velocity", solid.velocity},
                                  {"angular_velocity", solid.angular_velocity}});
    }
    json["boundaries"] = nlohmann::json::array();
    for (const Face face : {kXMin, kXMax, kYMin, kYMax, kZMin, kZMax})
        json["boundaries"].push_back({{"flux", fluid.boundary_flux(face)}, {"force", fluid.boundary_force(face)}});
    const double k = fluid.permeability();
    json["permeability"] = std::isfinite(k) ? nlohmann::json(k) : nlohmann::json(nullptr);
    json["mass_drift"] = fluid.total_mass() / mass - 1;
    json["max_mach"] = fluid.max_mach();
    const double cells = double(input.fluid.cells[0]) * input.fluid.cells[1] * input.fluid.cells[2];
    json["mlups"] = elapsed > 0 ? cells * fluid.steps() / elapsed / 1e6 : 0.0;
    json["seconds"] = elapsed;
    return {json, converged, not_written};
}

}  // namespace lbm
