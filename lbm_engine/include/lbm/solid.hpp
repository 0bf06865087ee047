#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace lbm {

using Vec3 = std::array<double, 3>;
using Mat3 = std::array<Vec3, 3>;

enum class Shape {
    sphere,  ///< of `radius`
    box,     ///< of `half_extents`, turned by `orientation`
    pipe     ///< everything outside an endless bore of `radius` along `axis`
};

/**
 * A rigid solid in the fluid, as the caller knows it at the start of a fluid step. SI units.
 *
 * A finite `mass` (with its `inertia`) says that the solid answers to its load: the load is then passed on with the
 * relaxation that keeps light particles stable. Infinite values say that the motion is prescribed (or none). Parts of one rigid
 * body all give the mass and inertia of the body; its load is the sum of theirs, with the moments of their forces.
 */
struct Solid {
    std::int64_t id = 0;  ///< the caller's key; unique among the solids of one fluid
    std::int64_t body =
        -1;  ///< solids with the same number >= 0 move as one rigid body: where they overlap, their common volume counts once
    Shape shape = Shape::sphere;
    double radius = 0;    ///< of a sphere or bore [m], at least two cells
    Vec3 half_extents{};  ///< of a box along its own axes [m], each at least one cell
    std::array<double, 4> orientation{1, 0, 0,
                                      0};  ///< of a box: the unit quaternion (w, x, y, z) that turns it from the axes
    int axis = 0;                          ///< of a pipe: 0, 1, 2 for x, y, z
    Vec3 position{};                       ///< of the centre [m]; need not be wrapped in periodic directions
    Vec3 velocity{};                       ///< of the centre [m/s]
    Vec3 angular_velocity{};               ///< [rad/s]
    Vec3
        lever{};  ///< from the centre of mass of the rigid body that it is a part of to its own centre; for films alone [m]
    double mass = std::numeric_limits<double>::infinity();  ///< of the whole rigid body [kg], > 0
    double inertia =
        std::numeric_limits<double>::infinity();  ///< smallest principal moment, of the whole rigid body [kg m2], > 0
    std::array<bool, 3> held{};  ///< along which axes it moves as it is told though `mass` is finite; for films alone
};

/**
 * What the fluid does to one solid, as seen from outside it: the inertia of the fluid that fills the solid on the
 * lattice is accounted for, so that m dV/dt = force + (weight and contacts), with no added mass.
 *
 * `force` contains buoyancy, - rho_f V gravity, and the drive's mean pressure gradient, + rho_f V acceleration, so that
 * the loads in a periodic bed at rest add up to rho_f * acceleration * (volume of the box).
 */
struct SolidLoad {
    Vec3 force{};                 ///< [N]
    Vec3 torque{};                ///< about the solid's centre [N m]
    Mat3 stresslet{};             ///< symmetric, traceless first moment of the surface traction [N m]
    double isotropic_moment = 0;  ///< a third of the trace of that moment [N m]
};

}  // namespace lbm
