#pragma once

#include "fields/populations.hpp"
#include "fields/solid_map.hpp"
#include "physics/collision.hpp"

namespace lbm {

/**
 * Brings the populations to another relaxation time, and with it to another time step, in the same flow.
 *
 * With s = Lp' / Lp = dt' / dt, in lattice units velocities scale with s, density deviations and forces with s^2. Of the parts out of
 * equilibrium, omega+ f+ scales with s and omega- f- with s^2: in steady Stokes flow this is the very state that the new relaxation time has.
 *
 * @param from    parameters that the populations belong to; the solids' velocities belong to them too
 * @param to      of the same magic parameter, with the same body force in SI units
 */
template <class L, class T>
void rescale(Populations<L, T>& populations, const CollisionParameters& from, const CollisionParameters& to,
             bool inertia, const SolidMap& solids);

}  // namespace lbm
