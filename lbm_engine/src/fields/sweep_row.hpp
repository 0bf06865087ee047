#pragma once

#include "fields/populations.hpp"
#include "fields/row_saturation.hpp"
#include "physics/collision.hpp"

namespace lbm {

/// What the sweep sees of speeds and densities on its way: for the watchdog.
struct FlowWatch {
    double max2 = 0;   ///< largest u^2
    double sum2 = 0;   ///< sum of u^2; not finite if any population is not
    double drho2 = 0;  ///< largest (rho - 1)^2

    void see(const FlowWatch& other)
    {
        max2 = other.max2 > max2 ? other.max2 : max2;
        sum2 += other.sum2;
        drho2 = other.drho2 > drho2 ? other.drho2 : drho2;
    }
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
                          RowSaturation* cells, FlowWatch& watch) noexcept;

template <class L, class T>
struct SweepRows {
    SweepRow<L, T> inertia, stokes;
};

/// The widest variant that this processor runs. All variants give the same bits.
template <class L, class T>
SweepRows<L, T> sweep_rows();

}  // namespace lbm
