#pragma once

#include "fields/lattice_solid.hpp"
#include "fields/neighbours.hpp"
#include "physics/narrow_pore.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace lbm {

/**
 * Which spheres stand opposite each other across narrow pores (CutCells): those of other bodies, their images behind periodic faces, and mirror images, its own
 * images among them. Members of one rigid body have no pores between them.
 */
class NarrowPores {
public:
    /**
     * @param periodic  for each axis
     * @param mirrors   faces behind which a sphere sees its mirror image
     */
    NarrowPores(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic,
                const std::array<bool, 6>& mirrors)
        : n_(cells)
        , periodic_(periodic)
        , mirrors_(mirrors)
        , any_mirror_(std::find(mirrors.begin(), mirrors.end(), true) != mirrors.end())
        , neighbours_(cells, periodic)
    {
    }

    /// Sorts the solids, before anything is found.
    void search(const std::vector<LatticeSolid>& solids);

    /// What stands opposite a solid; nothing where it is not a sphere.
    void find(std::size_t solid, const std::vector<LatticeSolid>& solids, std::vector<Opposite>& opposite) const;

private:
    bool is_nearest(const Vec3& image, const Vec3& to) const;

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    std::array<bool, 6> mirrors_;
    bool any_mirror_;
    Neighbours neighbours_;
    std::vector<Vec3> centres_;
    double largest_ = 0;  // radius; 0: no spheres
};

}  // namespace lbm
