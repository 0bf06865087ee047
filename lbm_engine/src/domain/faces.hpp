#pragma once

#include "fields/populations.hpp"
#include "lbm/fluid_config.hpp"

#include <vector>

namespace lbm {

/**
 * What enters the box through its faces, edges and corners.
 *
 * In the AA pattern every link that leaves the box is one ghost slot, and its partner is one slot inside: the same population on the far side where the
 * box is periodic, the reflected one at a wall (half-way bounce-back, with 6 w rho_0 c.u_wall for a moving wall). The
 * ghosts are filled before a step of odd parity reads them, and drained after it wrote them; no ghost is ever the source of another, so order does not matter.
 *
 * Where a link crosses several walls at once (edges, corners), the wall velocity is the mean of theirs.
 * @see Ladd (1994), J. Fluid Mech. 271, 285
 */
class Faces {
public:
    /// @param conditions  in lattice units; both faces of a periodic pair periodic
    template <class L>
    Faces(const Layout<L>& layout, const std::array<FaceCondition, 6>& conditions);

    /// Faces along x, ghost <- partner, as soon as row (y, z) has made its step and while it is in cache. Rows in any order, by any thread.
    template <class T>
    void fill_row(T* f, int y, int z) const;
    /// Faces along x, partner <- ghost.
    template <class T>
    void drain_row(T* f, int y, int z) const;

    /// The other faces, ghost <- partner. After the step that made parity odd.
    template <class T>
    void fill(T* f) const;
    /// The other faces, partner <- ghost. After the step that made parity even.
    template <class T>
    void drain(T* f) const;

    /// Makes what left through the faces agree with what came in, after populations were changed between two steps.
    template <class T>
    void restore(T* f, bool odd) const;

private:
    /// A block of links of one direction: slots ghost + d.stride and partner + d.stride, 0 <= d < extent.
    struct Links {
        Slot ghost, partner;
        std::array<int, 3> first, extent;  ///< of the ghosts
        const int (&c)[3];                 ///< into the box
        bool wall;
        double gain;  ///< what a moving wall adds
    };
    template <class T, class Move>
    static void for_links(const std::vector<Links>& all, const std::array<Slot, 3>& stride, T* f, Move move);
    template <class T, class Move>
    void for_links_of_row(T* f, int y, int z, bool fill, Move move) const;

    std::array<Slot, 3> stride_;
    std::vector<Links> x_links_, links_;
};

}  // namespace lbm
