#pragma once

#include "lattice/vec3.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {

/**
 * The momentum bookkeeping of one solid (docs/physics.md, "Loads"), in lattice units.
 *
 * - sum F_s contains the inertia of the fluid inside the solid. What the solid gains from the fluid outside is, exactly,
 *
 *     L^n = - sum F_s^n + P_in^n - P_in^(n-1),   P_in = sum eps j_post,
 *
 * and the same for moments. The load is passed on through a virtual mass of the size of B = sum (1 - eps) kk rho, which keeps
 * light solids stable: of everything taken from the fluid and not passed on yet, `owed`, a share (load_share) is passed on in each step. Nothing is lost:
 * what was taken equals what was passed on plus what is owed.
 */
struct LoadLedger {
    Vec3 momentum{}, angular_momentum{};  ///< P_in, L_in after the last step
    Vec3 owed{}, owed_moment{};
    Vec3 arrears{}, arrears_moment{};  ///< owed from before a change of the time step, passed on little by little
    double arrears_rate = 0;           ///< part of them in each step

    struct Load {
        Vec3 force, torque;
    };

    /**
     * Books one step.
     * @param force, torque               sum F_s, sum r x F_s
     * @param inside, angular_inside      P_in, L_in after this step
     * @param share, spin_share           load_share of m and B, of I and B_w; 1 for a solid whose motion is prescribed
     */
    Load settle(const Vec3& force, const Vec3& torque, const Vec3& inside, const Vec3& angular_inside, double share,
                double spin_share)
    {
        owed += (inside - momentum) - force;
        owed_moment += (angular_inside - angular_momentum) - torque;
        momentum = inside;
        angular_momentum = angular_inside;
        const Load load{share * owed, spin_share * owed_moment};
        owed -= load.force;
        owed_moment -= load.torque;
        const Load old{arrears_rate * arrears, arrears_rate * arrears_moment};
        arrears -= old.force;
        arrears_moment -= old.torque;
        return {load.force + old.force, load.torque + old.torque};
    }

    bool is_settled() const
    {
        const Vec3 zero{};
        return owed == zero && owed_moment == zero && arrears == zero && arrears_moment == zero;
    }

    /// All that was taken and not passed on yet.
    Vec3 outstanding() const { return owed + arrears; }
    Vec3 outstanding_moment() const { return owed_moment + arrears_moment; }

    /// The centre, about which all moments are, moves by `shift`.
    void move(const Vec3& shift)
    {
        angular_momentum -= cross(shift, momentum);
        owed_moment -= cross(shift, owed);
        arrears_moment -= cross(shift, arrears);
    }

    /**
     * The time step becomes s times what it was (lattice units change with it). In a steady motion what is owed goes with dt^2; the
     * difference is paid, or saved up, over some twenty of the longer steps, so that the load does not jump.
     * @param inside, angular_inside  P_in, L_in that the load of the next step is to be counted from
     */
    void change_time_step(double s, const Vec3& inside, const Vec3& angular_inside)
    {
        momentum = inside;
        angular_momentum = angular_inside;
        const double steady = s * s * s;
        arrears = s * arrears + (s - steady) * owed;
        arrears_moment = s * arrears_moment + (s - steady) * owed_moment;
        owed = steady * owed;
        owed_moment = steady * owed_moment;
        arrears_rate = 0.05 * std::min(s, 1.0);
    }
};

/**
 * The share of the load that a free solid gets at once, 1 / (1 + B/m + (B/m)^2); 1 for infinite m.
 *
 * B is what the load answers to the solid's velocity within the step, and m / (m + B) would do for that alone. The fluid inside answers in the steps
 * after it with changing signs, the more the lighter the solid is; the square takes care of that, and is nothing to heavy solids.
 */
[[nodiscard]] inline double load_share(double mass, double coupling)
{
    if (std::isinf(mass)) return 1;
    const double b = coupling / mass;
    return 1 / (1 + b + b * b);
}

/// Steps by which the velocity of a free solid is extrapolated before the fluid sees it: 3/4 for heavy ones, none for those that get a small share.
[[nodiscard]] constexpr double velocity_lead(double share) { return 0.75 * share * share * share; }

}  // namespace lbm
