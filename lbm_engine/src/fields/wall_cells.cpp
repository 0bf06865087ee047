#include "fields/wall_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lbm {
namespace {

double reach(const SolidGeometry& box, int axis) { return half_reach(box.axes, box.half_extents, axis); }

}  // namespace

WallCells::WallCells(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic,
                     std::vector<const LatticeSolid*> boxes)
    : n_(cells)
    , periodic_(periodic)
    , boxes_(std::move(boxes))
{
}

bool WallCells::contain(const LatticeSolid& box, const std::array<int, 3>& cell) const
{
    for (int d = 0; d < 3; ++d)
        if (!periodic_[d] && (cell[d] == 0 || cell[d] == n_[d] - 1)) return false;
    return is_under_surface(box.geometry, cell) &&
           std::none_of(boxes_.begin(), boxes_.end(), [&](const LatticeSolid* other) {
               const bool moves_alike =
                   other->velocity == box.velocity && other->angular_velocity == box.angular_velocity;
               return !moves_alike && is_beside(other->geometry, cell);
           });
}

/// Of a cell's centre to the nearest image of a box's centre, along an axis.
double WallCells::distance(const SolidGeometry& box, const std::array<int, 3>& cell, int axis) const
{
    double r = cell[axis] + 0.5 - box.centre[axis];
    if (periodic_[axis]) r -= n_[axis] * std::round(r / n_[axis]);
    return std::abs(r);
}

/// Of its own box; along an axis that the box fills it has no surface.
bool WallCells::is_under_surface(const SolidGeometry& box, const std::array<int, 3>& cell) const
{
    for (int d = 0; d < 3; ++d) {
        const double half = reach(box, d);
        const bool fills = periodic_[d] && 2 * half >= n_[d];
        if (!fills && distance(box, cell, d) > half - 1) return true;
    }
    return false;
}

bool WallCells::is_beside(const SolidGeometry& box, const std::array<int, 3>& cell) const
{
    for (int d = 0; d < 3; ++d)
        if (distance(box, cell, d) >= reach(box, d) + 1.5) return false;
    return true;
}

}  // namespace lbm
