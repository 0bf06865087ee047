#pragma once

#include "lbm/fluid_config.hpp"
#include "lbm/solid.hpp"

#include <cstdint>

namespace lbm::test {

/// A fluid for which SI and lattice units are the same: dx = 1, density = 1 and a viscosity that makes dt = 1.
inline FluidConfig lattice_config(const std::array<int, 3>& cells, double tau)
{
    FluidConfig c;
    c.cells = cells;
    c.dx = 1;
    c.density = 1;
    c.viscosity = (tau - 0.5) / 3;
    c.tau = tau;
    c.threads = 1;  // boxes of a unit test are too small for more
    return c;
}

inline void walls(FluidConfig& c, int axis) { c.faces[2 * axis].type = c.faces[2 * axis + 1].type = FaceType::no_slip; }

inline Solid sphere(std::int64_t id, const Vec3& position, double radius, std::int64_t body = -1)
{
    Solid s;
    s.id = id;
    s.body = body;
    s.position = position;
    s.radius = radius;
    return s;
}

}  // namespace lbm::test
