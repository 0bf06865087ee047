#pragma once

#include "fields/lattice_solid.hpp"

#include <array>
#include <vector>

namespace lbm {

/**
 * Which cells of boxes whose surfaces run between cells turn populations round: those under a surface, so that the wall stands exactly half-way to the fluid.
 *
 * Not those beside a face of the lattice or another box that moves otherwise: between two such surfaces in sliding contact populations would grow without
 * bound. So the answer for one box depends on all of them.
 */
class WallCells {
public:
    /**
     * @param periodic  for each axis
     * @param boxes     all there are; referred to, not copied
     */
    WallCells(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic,
              std::vector<const LatticeSolid*> boxes);

    /// @param cell  of the box, not wrapped
    bool contain(const LatticeSolid& box, const std::array<int, 3>& cell) const;

private:
    double distance(const SolidGeometry& box, const std::array<int, 3>& cell, int axis) const;
    bool is_under_surface(const SolidGeometry& box, const std::array<int, 3>& cell) const;
    bool is_beside(const SolidGeometry& box, const std::array<int, 3>& cell) const;

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    std::vector<const LatticeSolid*> boxes_;
};

}  // namespace lbm
