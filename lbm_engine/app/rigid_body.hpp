#pragma once

#include "lbm/solid.hpp"

#include <cstddef>
#include <vector>

namespace lbm {

/// A solid that a rigid body is made of, by its index in the case, and its density [kg/m3]. Overlaps belong to the part that comes first.
struct RigidBodyPart {
    std::size_t solid;
    double density;
};

/**
 * A free rigid body of one or several spheres and boxes. SI units.
 *
 * A step is semi-implicit: velocities with the loads, then positions with these velocities. The angular momentum is what is kept, and so conserved to round-off without
 * torque; the axes follow it by the midpoint rule, of second order.
 */
class RigidBody {
public:
    /**
     * Takes mass, centre and moments from the parts, velocities from the first of them, and gives the solids theirs: `mass`, `inertia`, `lever`.
     * Parts that overlap are integrated over 64 points along each axis.
     * @throws ConfigError  if the velocities of the parts are not those of one rigid body
     */
    RigidBody(std::vector<RigidBodyPart> parts, std::vector<Solid>& solids);

    /// Velocities after a step `dt` under loads and gravity, for the body and its solids.
    void push(const std::vector<SolidLoad>& loads, const Vec3& gravity, double dt, std::vector<Solid>& solids);
    /// Places after a step `dt`, for the body and its solids.
    void move(double dt, std::vector<Solid>& solids);

private:
    /// Angular velocity of the body with its axes turned by q.
    Vec3 spin(const std::array<double, 4>& q) const;
    void pass_on(std::vector<Solid>& solids) const;

    struct Arm {
        std::size_t solid;
        Vec3 start;                         ///< from the body's centre to the solid's, before any turn
        std::array<double, 4> orientation;  ///< of the solid, before any turn
    };
    std::vector<Arm> arms_;
    double mass_ = 0;
    Mat3 inverse_inertia_{};  ///< about the centre, before any turn
    Vec3 centre_{}, velocity_{}, angular_momentum_{};
    std::array<double, 4> turn_{1, 0, 0, 0};  ///< unit quaternion (w, x, y, z) since the start
};

}  // namespace lbm
