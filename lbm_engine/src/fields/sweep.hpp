#pragma once

#include "fields/cell_state.hpp"
#include "fields/populations.hpp"
#include "fields/solid_map.hpp"
#include "fields/sweep_row.hpp"

#include <functional>

namespace lbm {

/**
 * Collides and streams all cells once and leaves the solids' sums in the map. Flips the parity; the faces come next.
 * @param heard      false: the sums are not asked for, and mean nothing; all solids are fixed
 * @param after_row  called as after_row(y, z) when a row has made its step; rows in any order, by any thread
 */
template <class L, class T>
FlowWatch sweep(Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                bool heard, const std::function<void(int, int)>& after_row);

/**
 * Fills the solids' sums of momentum inside them, and no others.
 * @param momentum  of a cell: member of CellState
 */
template <class L, class T>
void sum_inside(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                Vec3 CellState::*momentum);
/**
 * The same of a fluid that is alike everywhere, which need not be looked at.
 * @param momentum  of each cell
 * @param nx        cells along x
 */
void sum_inside(const Vec3& momentum, const CollisionParameters& p, SolidMap& solids, int nx);

}  // namespace lbm
