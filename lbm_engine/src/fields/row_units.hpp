#pragma once

#include "lattice/wrap.hpp"

#include <algorithm>
#include <cstddef>

namespace lbm {

/**
 * The rows of the lattice in units of neighbouring ones: planes, or parts of planes where there are few. A unit is swept by one thread, in order; units
 * depend on the lattice alone, so that sums within them, added up unit by unit, do not depend on the number of threads.
 */
struct RowUnits {
    int ny, nz;
    int rows, planes;  ///< of a unit; the last ones may have fewer

    RowUnits(int ny_, int nz_);
    int along_y() const noexcept { return (ny + rows - 1) / rows; }
    int along_z() const noexcept { return (nz + planes - 1) / planes; }
    int count() const noexcept { return along_y() * along_z(); }
};

/// Calls body(row, y, z) for all rows of a unit.
template <class Body>
void for_rows_of(const RowUnits& units, int unit, Body body)
{
    const int along_y = units.along_y(), y0 = unit % along_y * units.rows, z0 = unit / along_y * units.planes;
    for (int z = z0; z < std::min(z0 + units.planes, units.nz); ++z)
        for (int y = y0; y < std::min(y0 + units.rows, units.ny); ++y)
            body(static_cast<std::size_t>(z) * units.ny + y, y, z);
}

/// The same for all rows; to be called by all threads of a team, which share the units.
template <class Body>
void for_rows(const RowUnits& units, Body body)
{
#pragma omp for schedule(static)
    for (int unit = 0; unit < units.count(); ++unit) for_rows_of(units, unit, body);
}

/// Goes along an axis, over cells that need not be wrapped, unit by unit.
struct Walk {
    int left;        ///< cells, from this one on
    int n, size;     ///< cells of the lattice, and in a unit
    int cell;        ///< wrapped
    int image = 0;   ///< not wrapped it is cell + image n
    int passed = 0;  ///< units, a single one that is met again not counted

    Walk(int first, int count, int n_, int size_) : left(count), n(n_), size(size_), cell(first)
    {
        // Solids reach into the next image, rarely further.
        if (cell < -n || cell >= 2 * n) {
            cell = wrap(cell, n);
            image = (first - cell) / n;
        } else if (cell < 0) {
            cell += n;
            image = -1;
        } else if (cell >= n) {
            cell -= n;
            image = 1;
        }
    }
    int unit() const { return cell / size; }
    /// Cells from this one on in its unit and image.
    int count() const { return std::min({left, size - cell % size, n - cell}); }
    void next()
    {
        const int cells = count();
        left -= cells;
        cell += cells;
        if (cell < n) {
            ++passed;
            return;
        }
        cell = 0;
        ++image;
        passed += n > size;
    }
};

/// Units in which `count` cells from `first` on lie, along an axis with n of them.
int units_along(int first, int count, int n, int size);

}  // namespace lbm
