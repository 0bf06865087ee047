#include "facade/implementation.hpp"

#include "facade/validate.hpp"
#include "fields/rescale.hpp"
#include "lattice/message.hpp"

#include <algorithm>
#include <chrono>
#include <new>

namespace lbm {
namespace {

/// Lambda of two relaxation times.
double magic_parameter(const FluidConfig& c)
{
    if (!std::isnan(c.magic_parameter)) return c.magic_parameter;
    return c.scheme == Scheme::exact ? kLambdaLowNoise : kLambdaPublished;
}

CollisionParameters collision_parameters(const FluidConfig& c, const Units& units)
{
    const double Lp = c.tau - 0.5;
    const double lambda = c.collision == Collision::bgk ? Lp * Lp : magic_parameter(c);
    CollisionParameters p{TrtRates(c.tau, lambda), {}, Weighting(c.lattice, magic_parameter(c)).low_noise, c.scheme};
    for (int d = 0; d < 3; ++d) p.body_force[d] = c.acceleration[d] / units.acceleration;
    return p;
}

std::array<FaceCondition, 6> lattice_faces(const FluidConfig& c, const Units& units)
{
    auto faces = c.faces;
    for (FaceCondition& face : faces) {
        face.velocity = (1 / units.velocity) * face.velocity;
        // as a deviation of the density from rho_0
        face.pressure /= units.pressure * kSpeedOfSound * kSpeedOfSound;
    }
    return faces;
}

/// Of the pressure faces: where the fluid starts from.
double mean_face_pressure(const std::array<FaceCondition, 6>& faces)
{
    double sum = 0;
    int number = 0;
    for (const FaceCondition& face : faces)
        if (face.type == FaceType::pressure) {
            sum += face.pressure;
            ++number;
        }
    return number ? sum / number : 0;
}

std::array<bool, 3> periodic_axes(const FluidConfig& c)
{
    std::array<bool, 3> periodic;
    for (int d = 0; d < 3; ++d) periodic[d] = c.faces[2 * d].type == FaceType::periodic;
    return periodic;
}

FluidConfig validated(const FluidConfig& config)
{
    validate(config);
    return config;
}

template <class L>
AnyPopulations make_populations_of(const FluidConfig& c)
{
    if (c.storage == Storage::single_precision) return Populations<L, float>(c.cells);
    return Populations<L, double>(c.cells);
}

AnyPopulations make_populations(const FluidConfig& c)
{
    const ThreadCount threads(c.threads);
    try {
        return c.lattice == Lattice::d3q27 ? make_populations_of<D3Q27>(c) : make_populations_of<D3Q19>(c);
    } catch (const std::bad_alloc&) {
        throw ConfigError(message("cells = ", c.cells[0], " x ", c.cells[1], " x ", c.cells[2],
                                  ": more memory than there is; use a larger dx, or single storage"));
    }
}

/// The axes of a box turned by a unit quaternion (w, x, y, z).
Mat3 rotated_axes(const std::array<double, 4>& q)
{
    const auto [w, x, y, z] = q;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
             {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
             {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

class Stopwatch {
public:
    /// Seconds since construction or the last lap.
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

Fluid::Implementation::Implementation(const FluidConfig& c)
    : config(validated(c))
    , dt(fluid_time_step(c.tau, c.dx, c.viscosity / c.density))
    , units(c.dx, dt, c.density)
    , collision(collision_parameters(c, units))
    , populations(make_populations(c))
    , faces(std::visit([&](const auto& f) { return Faces(f.layout, lattice_faces(c, units), c.inertia); }, populations))
    , map(c.cells, periodic_axes(c), Weighting(c.lattice, magic_parameter(c)))
    , films(c.cells, periodic_axes(c), c.lubrication_roughness)
{
    start_at(mean_face_pressure(lattice_faces(c, units)));
}

/// Gives the fluid at rest a density deviation. All slots, since what left through the faces has to fit too.
void Fluid::Implementation::start_at(double drho)
{
    if (drho == 0) return;
    const ThreadCount threads(config.threads);
    std::visit(
        [&]<class L, class T>(Populations<L, T>& f) {
            const Layout<L>& layout = f.layout;
#pragma omp parallel for schedule(static)
            for (int z = -1; z <= layout.n[2]; ++z)
                for (int y = -1; y <= layout.n[1]; ++y)
                    for (int i = 0; i < L::Q; ++i)
                        std::fill_n(f.data() + layout.slot(i, -1, y, z), layout.n[0] + 2,
                                    static_cast<T>(L::w(i) * drho));
        },
        populations);
}

LatticeSolid Fluid::Implementation::in_lattice_units(const Solid& solid) const
{
    LatticeSolid lattice;
    SolidGeometry& geometry = lattice.geometry;
    geometry.shape = solid.shape;
    geometry.radius = solid.radius / units.length;
    geometry.half_extents = (1 / units.length) * solid.half_extents;
    geometry.axes = rotated_axes(solid.orientation);
    geometry.axis = solid.axis;
    lattice.body = solid.body;
    lattice.velocity = (1 / units.velocity) * solid.velocity;
    lattice.angular_velocity = units.time * solid.angular_velocity;
    for (int d = 0; d < 3; ++d) {
        double x = (solid.position[d] - config.lower[d]) / units.length;
        if (config.faces[2 * d].type == FaceType::periodic) x -= config.cells[d] * std::floor(x / config.cells[d]);
        // Beyond the reach of the lattice nothing is mapped; the distance itself must stay countable.
        const double reach = 1e6 + geometry.radius + norm(geometry.half_extents);
        geometry.centre[d] = std::clamp(x, -reach, config.cells[d] + reach);
    }
    return lattice;
}

/**
 * A free solid with the velocity that it will have within the step, as far as its last two tell. The load of a step acts on the solid after it, so the
 * drag would lag behind the motion; most of the lag is taken out so, less for light solids, whose stability would suffer.
 */
Solid Fluid::Implementation::in_mid_step(const Solid& solid, const Motion& last) const
{
    Solid mid = solid;
    if (std::isfinite(solid.mass)) mid.velocity += velocity_lead(last.share) * (solid.velocity - last.velocity);
    if (std::isfinite(solid.inertia))
        mid.angular_velocity += velocity_lead(last.spin_share) * (solid.angular_velocity - last.angular_velocity);
    return mid;
}

bool Fluid::Implementation::is_same(const Solid& now, const Solid& before) const
{
    double distance2 = 0;
    for (int d = 0; d < 3; ++d) {
        double moved = now.position[d] - before.position[d];
        const double length = config.cells[d] * config.dx;
        if (config.faces[2 * d].type == FaceType::periodic) moved -= length * std::round(moved / length);
        distance2 += moved * moved;
    }
    const auto& h = now.half_extents;
    const double jump = now.shape == Shape::box ? std::min({h[0], h[1], h[2]}) : now.radius;
    return now.id == before.id && now.shape == before.shape && now.radius == before.radius &&
           now.half_extents == before.half_extents && now.axis == before.axis && distance2 <= jump * jump;
}

void Fluid::Implementation::place(const std::vector<Solid>& now)
{
    const ThreadCount threads(config.threads);
    Stopwatch watch;
    const auto count = static_cast<std::ptrdiff_t>(now.size());
    bool same_ids = now.size() == solids.size();
    for (std::ptrdiff_t s = 0; same_ids && s < count; ++s) same_ids = is_same(now[s], solids[s]);
    validate(config, now);
    if (!same_ids) require_unique_ids(now);

    std::vector<int> previous(now.size());
    bool any_new = false;
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        if (same_ids) {
            previous[s] = static_cast<int>(s);
            continue;
        }
        const auto found = index_of_id.find(now[s].id);
        const bool known = found != index_of_id.end() && is_same(now[s], solids[found->second]);
        previous[s] = known ? found->second : -1;
        any_new = any_new || !known;
    }
    std::vector<LatticeSolid> lattice_solids(now.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s)
        lattice_solids[s] = in_lattice_units(previous[s] < 0 ? now[s] : in_mid_step(now[s], last_motions[previous[s]]));
    map.update(lattice_solids, previous);
    if (!same_ids) {
        std::vector<LoadLedger> kept(now.size());
        std::vector<Motion> motions(now.size());
        std::vector<FilmMemory> memories(now.size());
        if (any_new)
            std::visit([&](const auto& f) { sum_inside(f, collision, config.inertia, map, &CellState::momentum); },
                       populations);
        index_of_id.clear();
        for (std::ptrdiff_t s = 0; s < count; ++s) {
            index_of_id.emplace(now[s].id, static_cast<int>(s));
            if (previous[s] >= 0) {
                kept[s] = ledgers[previous[s]];
                motions[s] = last_motions[previous[s]];
                memories[s] = film_memories[previous[s]];
            } else {
                motions[s] = {now[s].velocity, now[s].angular_velocity, 0, 0};
                memories[s] = {now[s].velocity, now[s].angular_velocity, {}, {}, {}, {}};
                const SolidSums sums = map.sums(s);
                kept[s].momentum = sums.momentum;
                kept[s].angular_momentum = sums.angular_momentum;
            }
        }
        ledgers = std::move(kept);
        last_motions = std::move(motions);
        film_memories = std::move(memories);
        loads.assign(now.size(), SolidLoad{});
    }
    solids = now;
    times.map += watch.lap();
}

void Fluid::Implementation::step()
{
    const ThreadCount threads(config.threads);
    watch_surfaces();
    Stopwatch watch_time;
    std::visit(
        [&](auto& f) {
            auto* const slots = f.data();
            const auto x_faces = [&, to_odd = !f.odd](int y, int z) { faces.stream_row(slots, y, z, to_odd); };
            const FlowWatch flow = sweep(f, collision, config.inertia, map, x_faces);
            times.collide_stream += watch_time.lap();
            faces.stream(f.data(), f.odd);
            times.exchange += watch_time.lap();
            ++steps;
            watch(flow);
            max_speed2 = flow.max2;
        },
        populations);
    watch_time.lap();
    settle_loads();
    if (config.lubrication && config.scheme == Scheme::exact) add_film_loads();
    times.loads += watch_time.lap();
}

void Fluid::Implementation::change_tau(double tau)
{
    FluidConfig changed = config;
    changed.tau = tau;
    validate(changed);
    const double s = (tau - 0.5) / (config.tau - 0.5);  // dt' / dt
    const double mach = std::sqrt(max_speed2) / kSpeedOfSound * s;
    if (mach > config.max_mach)
        throw ConfigError(message("tau = ", tau, ": the present flow would have the Mach number ", mach,
                                  ", above the limit ", config.max_mach,
                                  "; use tau <= ", 0.5 + (tau - 0.5) * config.max_mach / mach));
    const ThreadCount threads(config.threads);
    const auto momenta_inside = [&] {
        std::visit([&](const auto& f) { sum_inside(f, collision, config.inertia, map, &CellState::next_momentum); },
                   populations);
        std::vector<SolidSums> all(solids.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = map.sums(i);
        return all;
    };
    const auto before = momenta_inside();
    const double new_dt = fluid_time_step(tau, config.dx, config.viscosity / config.density);
    const Units new_units(config.dx, new_dt, config.density);
    const CollisionParameters to = collision_parameters(changed, new_units);
    std::visit([&](auto& f) { rescale(f, collision, to, config.inertia, map); }, populations);

    time_before_dt = time();
    steps_before_dt = steps;
    config = changed;
    dt = new_dt;
    units = new_units;
    collision = to;
    max_speed2 *= s * s;
    rebuild_faces(s * s);
    std::visit([&](auto& f) { faces.restore(f.data(), f.odd); }, populations);
    map.scale_velocities(s);

    // What the solids hold changes from step to step by s^2 of what it did.
    const auto after = momenta_inside();
    for (std::size_t i = 0; i < ledgers.size(); ++i) {
        LoadLedger& ledger = ledgers[i];
        ledger.change_time_step(s, after[i].momentum - (s * s) * (before[i].momentum - ledger.momentum),
                                after[i].angular_momentum -
                                    (s * s) * (before[i].angular_momentum - ledger.angular_momentum));
    }
}

void Fluid::Implementation::change_faces(const std::array<FaceCondition, 6>& to)
{
    FluidConfig changed = config;
    changed.faces = to;
    for (int face = 0; face < 6; ++face)
        if (to[face].type != config.faces[face].type)
            throw ConfigError(message("face ", face, " along ", "xyz"[face / 2],
                                      ": its type cannot change any more; only velocities and pressures may"));
    validate(changed);
    config = changed;
    rebuild_faces(1);
}

void Fluid::Implementation::rebuild_faces(double dynamic_pressure_scale)
{
    std::visit(
        [&](const auto& f) {
            Faces next(f.layout, lattice_faces(config, units), config.inertia);
            next.take_over(faces, dynamic_pressure_scale);
            faces = std::move(next);
        },
        populations);
}

std::unordered_map<std::int64_t, Fluid::Implementation::Coupling> Fluid::Implementation::couplings_of_bodies() const
{
    std::unordered_map<std::int64_t, Coupling> of_bodies;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (solids[s].body < 0) continue;
        const SolidSums sums = map.sums(s);
        Coupling& coupling = of_bodies[solids[s].body];
        coupling.translation += sums.coupling;
        coupling.spin += sums.spin_coupling;
    }
    return of_bodies;
}

void Fluid::Implementation::settle_loads()
{
    const auto of_bodies = couplings_of_bodies();
    const auto count = static_cast<std::ptrdiff_t>(solids.size());
#pragma omp parallel for schedule(static) if (count > 8)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        const SolidSums sums = map.sums(s);
        const Solid& solid = solids[s];
        const bool part = solid.body >= 0;
        const Coupling coupling = part ? of_bodies.at(solid.body) : Coupling{sums.coupling, sums.spin_coupling};
        double share = load_share(solid.mass / units.mass, coupling.translation);
        double spin_share = load_share(solid.inertia / units.inertia, coupling.spin);
        // Turning moves the parts of a body: one share for all keeps its velocities those of a rigid body.
        if (part) share = spin_share = std::min(share, spin_share);
        const auto load =
            ledgers[s].settle(sums.force, sums.torque(), sums.momentum, sums.angular_momentum, share, spin_share);
        loads[s] = load_in_si(s, load, sums);
        last_motions[s] = {solids[s].velocity, solids[s].angular_velocity, share, spin_share};
    }
}

SolidLoad Fluid::Implementation::load_in_si(std::size_t s, const LoadLedger::Load& load, const SolidSums& sums) const
{
    SolidLoad si;
    si.force = units.force * load.force;
    si.torque = units.torque * load.torque;
    // The pressure gradients that the lattice does not carry: hydrostatic, and the drive's.
    si.force += (map.volume(s) * units.mass) * (config.acceleration - config.gravity);
    const Mat3& m = sums.first_moment;
    const double third = (m[0][0] + m[1][1] + m[2][2]) / 3;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            si.stresslet[a][b] = -units.torque * (0.5 * (m[a][b] + m[b][a]) - (a == b ? third : 0));
    si.isotropic_moment = -units.torque * third;
    return si;
}

constexpr double kNothing = 1e-6;  // of a cell: the volume in the box is a difference and carries round-off

/// Before the flow takes harm: no surface in the box may move faster than the flow may.
void Fluid::Implementation::watch_surfaces() const
{
    const double limit = config.max_mach * kSpeedOfSound * units.velocity;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        const Solid& solid = solids[s];
        const double reach = solid.shape == Shape::box ? norm(solid.half_extents) : solid.radius;
        const double spin = reach * norm(solid.angular_velocity);
        // |V + W x r| is largest where W x r has the direction of the part of V across W
        const double speed2 = dot(solid.velocity, solid.velocity);
        const double along = spin > 0 ? dot(solid.velocity, solid.angular_velocity) / norm(solid.angular_velocity) : 0;
        const double fastest = std::hypot(along, std::sqrt(std::max(0.0, speed2 - along * along)) + spin);
        if (fastest <= limit || map.volume(s) < kNothing) continue;
        const Vec3& at = solid.position;
        throw RunError(message("solid ", solid.id, " at (", at[0], ", ", at[1], ", ", at[2], ") before step ",
                               steps + 1, " (t = ", time(), " s): its surface moves at ", fastest, " m/s, ",
                               fastest / units.velocity, " cells per fluid step, Mach number ",
                               fastest / units.velocity / kSpeedOfSound, " is above the limit ", config.max_mach,
                               ": that needs a fluid step (now ", dt, " s) smaller by that ratio"));
    }
}

void Fluid::Implementation::watch(const FlowWatch& flow) const
{
    const double limit = config.max_mach * kSpeedOfSound;
    const bool diverged = !std::isfinite(flow.sum2);
    const bool too_fast = flow.max2 > limit * limit;
    if (!diverged && !too_fast && flow.drho2 <= kMaxDensityDeviation * kMaxDensityDeviation) return;

    std::vector<double> fluid_fraction(static_cast<std::size_t>(cell_count()));
    for_cells([&](const CellState& cell) { fluid_fraction[index(cell)] = 1 - cell.epsilon; });
    std::ptrdiff_t where = -1;
    double worst = -1, drho = 0;
    std::visit(
        [&]<class L, class T>(const Populations<L, T>& f) {
            const auto [nx, ny, nz] = f.layout.n;
            for (std::ptrdiff_t cell = 0; cell < static_cast<std::ptrdiff_t>(nx) * ny * nz; ++cell) {
                double p[L::Q];
                f.outgoing(static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny),
                           static_cast<int>(cell / nx / ny), p);
                const Moments<double> m = moments<L>(p);
                double bad = diverged || too_fast ? dot({m.j[0], m.j[1], m.j[2]}, {m.j[0], m.j[1], m.j[2]}) /
                                                        ((1 + m.drho) * (1 + m.drho))
                                                  : std::abs(fluid_fraction[static_cast<std::size_t>(cell)] * m.drho);
                if (!std::isfinite(bad)) bad = std::numeric_limits<double>::max();
                if (bad > worst) {
                    worst = bad;
                    drho = m.drho;
                    where = cell;
                }
            }
        },
        populations);
    const auto [nx, ny, nz] = config.cells;
    const std::ptrdiff_t at[3] = {where % nx, where / nx % ny, where / nx / ny};
    const auto in_metres = [&](int d) { return config.lower[d] + (static_cast<double>(at[d]) + 0.5) * config.dx; };
    const auto place = message("at step ", steps, " (t = ", time(), " s), cell (", at[0], ", ", at[1], ", ", at[2],
                               ") at (", in_metres(0), ", ", in_metres(1), ", ", in_metres(2), ") m");
    if (diverged)
        throw RunError(message("the fluid diverged ", place,
                               ": use a smaller time step of the fluid or more cells, or keep tau above 0.52"));
    if (too_fast)
        throw RunError(message("Mach number ", std::sqrt(flow.max2) / kSpeedOfSound, " ", place, " is above the limit ",
                               config.max_mach, ": the speed of ", std::sqrt(flow.max2) * units.velocity,
                               " m/s needs a fluid step (now ", dt, " s) smaller by that ratio"));
    throw RunError(message("the density is off by ", 100 * drho, " % ", place, ", a pressure of ",
                           drho / 3 * units.pressure, " Pa: above the limit of ", 100 * kMaxDensityDeviation,
                           " % the fluid is not nearly incompressible; use a smaller time step of the fluid (now ", dt,
                           " s), or let fluid leave a box that is filled"));
}

}  // namespace lbm
