#include "facade/implementation.hpp"

namespace lbm {
namespace {

/// Share of the newest step in the smoothed force of weight and contacts. One would follow at once, and ring with contacts.
constexpr double kNewest = 0.2;

/// v, shortened to a length if it is longer.
Vec3 limited(const Vec3& v, double length)
{
    const double is = norm(v);
    return is > length ? (length / is) * v : v;
}

void follow(Vec3& smoothed, const Vec3& seen) { smoothed += kNewest * (seen - smoothed); }

}  // namespace

/**
 * Adds what the lattice does not resolve of narrow gaps. Films are solved for the velocities at the end of the step, which need all forces: the fluid's are
 * known, weight and contacts are taken from how the solid moved in the last steps. Where solids touch, contacts change too fast for that: there the
 * change foreseen is at most the motion itself, so that grains at rest on each other feel no film.
 */
void Fluid::Implementation::add_film_loads()
{
    const auto count = static_cast<std::ptrdiff_t>(solids.size());
    std::array<const Vec3*, 6> walls{};
    std::array<Vec3, 6> wall_velocities;
    for (int face = 0; face < 6; ++face) {
        if (config.faces[face].type != FaceType::no_slip) continue;
        wall_velocities[face] = (1 / units.velocity) * config.faces[face].velocity;
        walls[face] = &wall_velocities[face];
    }
    film_spheres.resize(solids.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        const LatticeSolid solid = in_lattice_units(solids[s]);
        const double radius = solids[s].shape == Shape::sphere ? solid.geometry.radius : 0;
        film_spheres[s] = {solid.geometry.centre, radius, solid.body, {solid.velocity, solid.angular_velocity}};
    }
    films.find(film_spheres, walls, (config.tau - 0.5) / 3);
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        const Solid& solid = solids[s];
        FilmMemory& memory = film_memories[s];
        FilmBody& motion = film_spheres[s].motion;
        const bool foresee = film_dt > 0 && !films.touches(s);
        if (std::isfinite(solid.mass)) {
            if (foresee)
                follow(memory.other_force,
                       (1 / film_dt) * (solid.mass * (solid.velocity - memory.velocity) - memory.impulse));
            else memory.other_force = {};
            motion.inverse_mass = units.mass / solid.mass;
            const Vec3 gain = (dt / solid.mass / units.velocity) * (loads[s].force + memory.other_force);
            motion.velocity += foresee ? gain : limited(gain, norm(motion.velocity));
        }
        if (std::isfinite(solid.inertia)) {
            if (foresee)
                follow(memory.other_torque,
                       (1 / film_dt) * (solid.inertia * (solid.angular_velocity - memory.angular_velocity) -
                                        memory.angular_impulse));
            else memory.other_torque = {};
            motion.inverse_inertia = units.inertia / solid.inertia;
            const Vec3 gain = (dt * units.time / solid.inertia) * (loads[s].torque + memory.other_torque);
            motion.angular_velocity += foresee ? gain : limited(gain, norm(motion.angular_velocity));
        }
    }
    const auto& film_loads = films.solve(film_spheres, walls);
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        SolidLoad& load = loads[s];
        load.force += units.force * film_loads[s].force;
        load.torque += units.torque * film_loads[s].torque;
        for (int d = 0; d < 3; ++d) load.stresslet[d] += units.torque * film_loads[s].stresslet[d];
        FilmMemory& memory = film_memories[s];
        memory.velocity = solids[s].velocity;
        memory.angular_velocity = solids[s].angular_velocity;
        memory.impulse = dt * load.force;
        memory.angular_impulse = dt * load.torque;
    }
    film_dt = dt;
}

}  // namespace lbm
