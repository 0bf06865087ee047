#include "facade/implementation.hpp"

#include "facade/stopwatch.hpp"
#include "facade/validate.hpp"
#include "fields/available_memory.hpp"
#include "fields/rescale.hpp"
#include "lattice/message.hpp"

#include <algorithm>
#include <functional>
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
    Fluid::check(config);
    return config;
}

double bytes_of_populations(const FluidConfig& c)
{
    const bool single = c.storage == Storage::single_precision;
    const std::size_t bytes = single ? sizeof(float) : sizeof(double);
    const std::size_t slots =
        c.lattice == Lattice::d3q27 ? Layout<D3Q27>(c.cells, bytes).slots : Layout<D3Q19>(c.cells, bytes).slots;
    return static_cast<double>(slots * bytes);
}

[[noreturn]] void throw_too_large(const FluidConfig& c)
{
    throw ConfigError(message("cells = ", c.cells[0], " x ", c.cells[1], " x ", c.cells[2], ": need ",
                              bytes_of_populations(c) / 1e9, " GB of memory, ", available_memory() / 1e9,
                              " GB are available; use a larger dx",
                              c.storage == Storage::single_precision ? "" : ", or single storage"));
}

template <class L>
AnyPopulations make_populations_of(const FluidConfig& c)
{
    if (c.storage == Storage::single_precision) return Populations<L, float>(c.cells);
    return Populations<L, double>(c.cells);
}

AnyPopulations make_populations(const FluidConfig& c)
{
    const ThreadCount threads(c);
    return c.lattice == Lattice::d3q27 ? make_populations_of<D3Q27>(c) : make_populations_of<D3Q19>(c);
}

/// Faces that are mirrors of the flow (domain/faces.hpp).
std::array<bool, 6> mirrors(const FluidConfig& c)
{
    std::array<bool, 6> mirrors;
    for (int face = 0; face < 6; ++face)
        mirrors[face] = c.faces[face].type == FaceType::free_slip || c.faces[face].type == FaceType::pressure;
    return mirrors;
}

}  // namespace

void Fluid::check(const FluidConfig& config)
{
    validate(config);
    if (bytes_of_populations(config) > available_memory())
        throw_too_large(config);  // the system would kill who takes it
}

// cppcheck-suppress uninitMemberVar ; it does not see the initialisers of a constructor that is a try block
Fluid::Implementation::Implementation(const FluidConfig& c)
try : config(validated(c)), dt(fluid_time_step(c.tau, c.dx, c.viscosity / c.density)), units(c.dx, dt, c.density),
    collision(collision_parameters(c, units)), populations(make_populations(c)),
    faces(std::visit([&](const auto& f) { return Faces(f.layout, lattice_faces(c, units), c.inertia); }, populations)),
    map(c.cells, periodic_axes(c), mirrors(c), Weighting(c.lattice, magic_parameter(c)), c.scheme == Scheme::exact),
    films(c.cells, periodic_axes(c), c.lubrication_roughness) {
    start_at(mean_face_pressure(lattice_faces(c, units)), (1 / units.velocity) * c.initial_velocity);
} catch (const std::bad_alloc&) {
    throw_too_large(c);
}

std::size_t Fluid::Implementation::memory_bytes() const
{
    return std::visit([](const auto& f) { return f.memory.bytes(); }, populations) + map.memory_bytes();
}

void Fluid::Implementation::throw_out_of_memory(const char* asked) const
{
    throw RunError(message("no memory is left for ", asked, ": the fluid and the map of its solids take ",
                           1e-9 * static_cast<double>(memory_bytes()),
                           " GB already; the fluid is lost, start again with a larger dx",
                           config.storage == Storage::single_precision ? "" : ", or single storage"));
}

/**
 * The fluid in equilibrium at one density and velocity, half of the drive's sources short: the velocity of a step contains half of its drive. All slots, since what left through
 * the faces has to fit too.
 */
void Fluid::Implementation::start_at(double drho, const Vec3& u)
{
    const auto& F = collision.body_force;
    if (drho == 0 && u == Vec3{} && F[0] == 0 && F[1] == 0 && F[2] == 0) return;
    const ThreadCount threads(config);
    std::visit(
        [&]<class L, class T>(Populations<L, T>& f) {
            const Layout<L>& layout = f.layout;
            T start[L::Q];
            const double rho = config.inertia ? 1 + drho : 1;
            const double u2 = dot(u, u), uF = u[0] * F[0] + u[1] * F[1] + u[2] * F[2];
            for (int i = 0; i < L::Q; ++i) {
                const auto& c = L::c[i];
                const double cu = c[0] * u[0] + c[1] * u[1] + c[2] * u[2], cF = c[0] * F[0] + c[1] * F[1] + c[2] * F[2];
                double population = drho + 3 * (rho * cu - 0.5 * cF);
                if (config.inertia) population += rho * (4.5 * cu * cu - 1.5 * u2) - 0.5 * (9 * cu * cF - 3 * uF);
                start[i] = static_cast<T>(L::w(i) * population);
            }
#pragma omp parallel for schedule(static)
            for (int z = -1; z <= layout.n[2]; ++z)
                for (int y = -1; y <= layout.n[1]; ++y)
                    for (int i = 0; i < L::Q; ++i)
                        std::fill_n(f.data() + layout.slot(i, -1, y, z), layout.n[0] + 2, start[i]);
        },
        populations);
}

/// Whether the loads of a step say all that there is to know about it: nothing that the fluid took from a solid is passed on later.
bool Fluid::Implementation::loads_can_wait() const
{
    return map.all_fixed() &&
           std::all_of(ledgers.begin(), ledgers.end(), [](const LoadLedger& l) { return l.is_settled(); });
}

void Fluid::Implementation::step(int count)
{
    if (count < 0) throw ConfigError(message("step: count = ", count, ": it must not be negative"));
    constexpr int kHeard = 2;  // a load is told from the momenta inside the solid after two steps
    const bool wait = count > kHeard && loads_can_wait();
    for (int i = 0; i < count; ++i) make_step(!wait || i >= count - kHeard);
}

/// @param heard  whether the solids' loads are found
void Fluid::Implementation::make_step(bool heard)
{
    const ThreadCount threads(config);
    watch_surfaces();
    Stopwatch watch_time;
    std::visit(
        [&](auto& f) {
            auto* const slots = f.data();
            const auto x_faces = [&, to_odd = !f.odd](int y, int z) { faces.stream_row(slots, y, z, to_odd); };
            const FlowWatch flow = sweep(f, collision, config.inertia, map, heard, std::cref(x_faces));
            times.collide_stream += watch_time.lap();
            faces.stream(f.data(), f.odd);
            times.exchange += watch_time.lap();
            ++steps;
            watch(flow);
            max_speed2 = flow.max2;
        },
        populations);
    watch_time.lap();
    if (!placed) forget_carried();
    if (heard) settle_loads();
    placed = false;
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
    const ThreadCount threads(config);
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
            throw ConfigError(message("face ", kFaceNames[face],
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
        ledgers[s].momentum += carried_in[s].momentum;
        ledgers[s].angular_momentum += carried_in[s].moment;
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
    si.force -= (map.volume(s) * units.mass) * config.gravity;  // the lattice does not carry the hydrostatic pressure
    const Mat3& m = sums.first_moment;
    const double third = (m[0][0] + m[1][1] + m[2][2]) / 3;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            si.stresslet[a][b] = -units.torque * (0.5 * (m[a][b] + m[b][a]) - (a == b ? third : 0));
    si.isotropic_moment = -units.torque * third;
    return si;
}

}  // namespace lbm
