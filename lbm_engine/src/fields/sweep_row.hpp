#pragma once

#include "fields/populations.hpp"
#include "fields/row_saturation.hpp"
#include "physics/collision.hpp"

namespace lbm {

/// What the sweep sees of the speeds on its way: for the watchdog.
struct SpeedWatch {
    double max2 = 0;  ///< largest u^2
    double sum2 = 0;  ///< sum of u^2; not finite if any population is not
};

/**
 * Collides and streams one row of cells in place.
 * @param f      populations
 * @param slot   slot of f_i in the first cell of the row, for this parity; f*_i goes to slot[opposite(i)]
 * @param nx     cells
 * @param ahead  slots from this row to the one that will be swept next, to be fetched meanwhile
 * @param cells  the row's saturation, or null where no solid is
 */
template <class L, class T>
using SweepRow = void (*)(T* f, const Slot (&slot)[L::Q], int nx, Slot ahead, const CollisionParameters& p,
                          RowSaturation* cells, SpeedWatch& watch) noexcept;

template <class L, class T>
struct SweepRows {
    SweepRow<L, T> inertia, stokes;
};

/// The widest variant that this processor runs. All variants give the same bits.
template <class L, class T>
SweepRows<L, T> sweep_rows();

}  // namespace lbm
