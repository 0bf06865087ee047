#pragma once

#include "fields/populations.hpp"
#include "fields/row_saturation.hpp"
#include "fields/solid_map.hpp"

#include <functional>

namespace lbm {

/// The state of a cell between two steps, in lattice units.
struct CellState {
    int x, y, z;
    double epsilon;      ///< solid fraction
    double drho;         ///< rho - 1
    Vec3 u;              ///< velocity, with half of the body and solid forces
    Vec3 force;          ///< F_s that the next collision will apply
    Vec3 momentum;       ///< sum f c after the last collision
    Vec3 next_momentum;  ///< sum f c after the next one
};

using SeeCell = std::function<void(const CellState&)>;

/**
 * Reads the cells of one row in order.
 * @param cells  the row, saturated if it has solids
 */
template <class L, class T>
void read_row(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, int y, int z,
              const RowSaturation& cells, const SeeCell& see);

/// Reads all cells: rows in parallel, the cells of a row in order.
template <class L, class T>
void for_cells(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, const SolidMap& solids,
               const SeeCell& see);

}  // namespace lbm
