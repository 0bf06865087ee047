#pragma once

#include "lattice/vec3.hpp"
#include "lattice_units.hpp"

#include "lbm/fluid.hpp"

namespace lbm::test {

inline FaceCondition of(FaceType type) { return {type, {}, 0}; }
inline FaceCondition at_pressure(double p) { return {FaceType::pressure, {}, p}; }
inline FaceCondition with_velocity(const Vec3& u) { return {FaceType::velocity, u, 0}; }

inline void pair(FluidConfig& c, int axis, const FaceCondition& low, const FaceCondition& high)
{
    c.faces[2 * axis] = low;
    c.faces[2 * axis + 1] = high;
}

inline void run(Fluid& fluid, int steps)
{
    for (int t = 0; t < steps; ++t) fluid.step();
}

inline FluidConfig stokes(const std::array<int, 3>& cells, double tau)
{
    FluidConfig c = lattice_config(cells, tau);
    c.inertia = false;
    return c;
}

/// All kinds of faces, and a drive.
inline FluidConfig all_kinds_of_faces()
{
    FluidConfig c = lattice_config({13, 11, 12}, 0.7);
    c.acceleration = {1e-5, -2e-5, 1e-5};
    pair(c, 0, with_velocity({0.02, 0.01, 0}), at_pressure(0.002));
    pair(c, 1, of(FaceType::no_slip), of(FaceType::free_slip));
    c.faces[kYMin].velocity = {0.02, 0, 0.01};
    return c;
}

/// That moves and turns, in the middle of their box.
inline Solid moving_sphere()
{
    Solid s;
    s.radius = 2.9;
    s.position = {6, 5.3, 6.1};
    s.velocity = {0.01, -0.005, 0.02};
    s.angular_velocity = {0.001, 0.002, 0.001};
    return s;
}

}  // namespace lbm::test
