#pragma once

#include "lattice/vec3.hpp"

namespace lbm {

/**
 * Lubrication: what the lattice does not resolve of the thin film between two surfaces (docs/physics.md, "Films").
 *
 * A narrow gap h resists like 1/h when it is squeezed and like ln(1/h) when its surfaces slide or pump. The lattice resolves each of these as if the gap
 * had another width, h_seen; the correction is the difference of the asymptotes at h and h_seen:
 *
 *     squeeze  6 pi mu (a^2 (1/h - 1/h_seen) + a (1 + 7 L + L^2) / (5 (1 + L)^2) ln(h_seen / h))
 *     slide    2 pi mu a ln(h_seen / h)
 *     pump     6/5 pi mu a ln(h_seen / h)            a = a1 a2 / (a1 + a2), L = a2 / a1; a wall: a2 infinite
 *
 * @see Jeffrey & Onishi (1984), J. Fluid Mech. 139, 261; Goldman, Cox & Brenner (1967), Chem. Eng. Sci. 22, 637
 */
struct FilmResistance {
    double squeeze = 0;  ///< force per speed of approach
    double slide = 0;    ///< traction per difference of the surfaces' tangential velocities; at a wall also < 0
    double pump = 0;     ///< traction per sum of them, as measured from the contact
};

/// Widest gap that is corrected, between spheres and at a wall, and widest between spheres that resists a squeeze [cells].
inline constexpr double kWidestFilm = 0.97, kWidestFilmAtWall = 2.9, kWidestSqueeze = 0.71;

/// Gaps that the lattice seems to see in each of the motions [cells].
struct SeenGaps {
    double squeeze, slide, pump;
};
[[nodiscard]] SeenGaps seen_gaps(double gap, bool wall);

/**
 * @param viscosity  in the units of the result; lengths in one unit
 * @param a1, a2     radii; a2 infinite for a wall
 * @param gap        > 0
 */
[[nodiscard]] FilmResistance film_resistance(double viscosity, double a1, double a2, double gap, const SeenGaps& seen);

/// One of the two bodies of a film, velocity of its centre of mass; infinite mass (inverse 0) where its motion is prescribed.
struct FilmBody {
    Vec3 velocity{}, angular_velocity{};
    double inverse_mass = 0, inverse_inertia = 0;
    Vec3 yields{1, 1, 1};  ///< 0 along axes along which its motion is prescribed all the same
};

/**
 * A film between two bodies, and the impulses that it gives them in one step (dt = 1).
 *
 * Tangential velocities of the surfaces are seen from the frame that turns with the line of centres, so a pair that moves as one
 * rigid body feels nothing:
 *
 *     u1 = arm1 W1 x n - part1 v_t,   u2 = -arm2 W2 x n + part2 v_t       v = V2 - V1, part = arm / distance (wall: 0 and 1)
 *
 * and forces and torques follow from the tractions by virtual work: they are opposite, and keep the pair's angular momentum.
 */
struct Film {
    Vec3 normal{};  ///< from the first to the second
    double arm[2] = {0, 0};
    double part[2] = {0, 0};
    Vec3 lever[2] = {};  ///< from the centres of mass of the bodies to the centres of the surfaces
    FilmResistance resistance;

    double squeezed = 0;   ///< impulse on the second along the normal
    Vec3 sheared[2] = {};  ///< impulses of the tangential tractions on the two surfaces

    /**
     * Lets the film act on its bodies as if it were alone: backward Euler, so that it takes energy whatever the step, and never turns a motion round. Repeated for
     * all films it converges to the solution for all of them at once (Gauss-Seidel).
     * @return square of the change of the impulses
     */
    double relax(FilmBody& first, FilmBody& second);

    Vec3 force_on_second() const { return squeezed * normal + part[1] * sheared[1] - part[0] * sheared[0]; }
    /// About the centre of the surface.
    Vec3 torque_on(int which) const { return (which == 0 ? arm[0] : -arm[1]) * cross(normal, sheared[which]); }
    /// Symmetric, traceless first moment of the tractions on one body.
    Mat3 stresslet_of(int which) const;
};

/// Between two spheres, or a sphere and a wall (a2 infinite).
[[nodiscard]] Film make_film(const Vec3& normal, double a1, double a2, double distance, const FilmResistance& r);

}  // namespace lbm
