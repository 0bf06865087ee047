#pragma once

#include "fields/populations.hpp"
#include "lattice/vec3.hpp"

namespace lbm {

/**
 * Sum over all cells of the flux of momentum, sum f c c, in lattice units with the deviations f; the mean of what leaves a cell after a
 * collision and what arrives before the next. So every link between two cells counts once and one through a wall half, which is how a
 * mean over planes between the cells, walls included, counts them.
 */
template <class L, class T>
Mat3 momentum_flux(const Populations<L, T>& populations);

}  // namespace lbm
