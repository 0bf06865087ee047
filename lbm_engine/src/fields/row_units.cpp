#include "fields/row_units.hpp"

namespace lbm {

RowUnits::RowUnits(int ny_, int nz_) : ny(ny_), nz(nz_)
{
    constexpr int kUnits = 64;  // at most, about
    planes = (nz + kUnits - 1) / kUnits;
    const int parts = std::max(1, kUnits / nz);
    rows = (ny + parts - 1) / parts;
}

int units_along(int first, int count, int n, int size)
{
    int units = 1;
    for (Walk walk(first, count, n, size); walk.left > 0; walk.next()) units = walk.passed + 1;
    return std::min(units, (n + size - 1) / size);
}

}  // namespace lbm
