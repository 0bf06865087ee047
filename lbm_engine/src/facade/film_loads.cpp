#include "facade/implementation.hpp"
#include "facade/stopwatch.hpp"
#include "facade/validate.hpp"
#include "lattice/message.hpp"

namespace lbm {

/// Films know nothing of the fluid's step: theirs is one of the caller's, in units of its own.
const std::vector<SolidLoad>& Fluid::Implementation::film_loads(const std::vector<Solid>& now, double step)
{
    if (!(std::isfinite(step) && step > 0))
        throw ConfigError(message("dt = ", step, ": the step of the films must be finite and > 0 [s]"));
    loads_of_films.assign(now.size(), SolidLoad{});
    if (!config.lubrication || config.scheme != Scheme::exact) return loads_of_films;
    validate(config, now);
    const ThreadCount threads(config);
    Stopwatch watch;
    const Units own(config.dx, step, config.density);
    std::array<const Vec3*, 6> walls{};
    std::array<Vec3, 6> wall_velocities;
    for (int face = 0; face < 6; ++face) {
        if (config.faces[face].type != FaceType::no_slip) continue;
        wall_velocities[face] = (1 / own.velocity) * config.faces[face].velocity;
        walls[face] = &wall_velocities[face];
    }
    const auto count = static_cast<std::ptrdiff_t>(now.size());
    film_spheres.resize(now.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        const Solid& solid = now[s];
        FilmSphere& sphere = film_spheres[s];
        sphere.centre = centre_in_box(solid);
        sphere.radius = solid.shape == Shape::sphere ? solid.radius / own.length : 0;
        sphere.body = solid.body;
        sphere.motion = {(1 / own.velocity) * solid.velocity,
                         own.time * solid.angular_velocity,
                         own.mass / solid.mass,
                         own.inertia / solid.inertia,
                         {}};
        for (int d = 0; d < 3; ++d) sphere.motion.yields[d] = solid.held[d] ? 0 : 1;
        sphere.lever = (1 / own.length) * solid.lever;
    }
    const auto& found = films.solve(film_spheres, walls, config.viscosity / config.density / own.viscosity);
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        SolidLoad& load = loads_of_films[s];
        load.force = own.force * found[s].force;
        load.torque = own.torque * found[s].torque;
        for (int d = 0; d < 3; ++d) load.stresslet[d] = own.torque * found[s].stresslet[d];
    }
    for (int face = 0; face < 6; ++face) film_forces_on_walls[face] = own.force * films.forces_on_walls()[face];
    times.films += watch.lap();
    return loads_of_films;
}

}  // namespace lbm
