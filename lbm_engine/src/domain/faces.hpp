#pragma once

#include "fields/populations.hpp"
#include "lbm/fluid_config.hpp"

#include <functional>
#include <vector>

namespace lbm {

/**
 * What enters the box through its faces, edges and corners.
 *
 * A link leads from outside into a cell. What comes in along it is what left the box along another link, its source:
 *
 *     in = sign out + gain
 *
 *     periodic            source: the link that leaves on the far side                          sign +, gain 0
 *     noSlip, velocity    the link itself: half-way bounce-back                                 +, 6 w rho_0 c.u_wall
 *     freeSlip            specular: the normal turns round, the particle moves on along the face  +, 0
 *     pressure            the same                                                              -, 2 w (rho_wall - rho_0 + 3 rho u_n^2), half of u_n^2 where it enters
 *
 * In Stokes flow the last two are mirrors, exact for every flow: behind a freeSlip face stands the mirror image of the box, behind a pressure face its
 * negative (of p - p_wall and of the tangential velocity, so that p = p_wall and u_t = 0 on the face). Where a link crosses several faces it
 * bounces back if one of them is noSlip or velocity, else it is turned at each.
 *
 * In the AA pattern every link has one slot in the ghosts and one in its cell; in odd parity the ghost holds what comes in and the
 * cell what left, in even parity the other way round. No slot is both source and target, and no cell touches them before the next step: order does not matter.
 * @see Ladd (1994), J. Fluid Mech. 271, 285
 */
class Faces {
public:
    /// @param conditions  in lattice units, pressures as deviations of the density, drho = p / c_s^2; both faces of a periodic pair periodic
    /// @param inertia     whether pressure faces see the dynamic pressure
    template <class L>
    Faces(const Layout<L>& layout, const std::array<FaceCondition, 6>& conditions, bool inertia);

    /// Links across faces along x alone whose source is a cell of row (y, z): as soon as that row has made its step and while it is in
    /// cache. Rows in any order, by any thread. @param odd  parity after the step
    template <class T>
    void stream_row(T* f, int y, int z, bool odd) const;

    /// The other links, when all rows have made their step.
    template <class T>
    void stream(T* f, bool odd);

    /// Goes on from another time step: takes over the dynamic pressure, times `scale`.
    void take_over(const Faces& before, double scale);

    /// Makes what left through the faces agree with what came in, after populations were changed between two steps.
    template <class T>
    void restore(T* f, bool odd) const;

    /// What passes through a face between the last collision and the next one, in lattice units.
    struct Passage {
        double volume = 0;  ///< leaving the box; through a periodic face too
        Vec3 momentum{};    ///< given to the face by the fluid; none to a periodic one
        Vec3 moment{};      ///< of this momentum about the lower corner of the box, given half-way along each link
    };
    /**
     * By exchange over the links; the sums over all faces are exact. A link across several faces counts for each of them with the velocity normal to it. Of its
     * momentum the static pressure acts on each face's normal, the rest on the no-slip and velocity faces among them, if there are any.
     * @param drho  density deviation of a cell about to collide
     */
    template <class T>
    std::array<Passage, 6> passages(const T* f, bool odd, const std::function<double(int, int, int)>& drho) const;

private:
    /// The two slots of a link.
    struct Ends {
        Slot ghost, cell;
        Slot in(bool odd) const { return odd ? ghost : cell; }
        Slot out(bool odd) const { return odd ? cell : ghost; }
    };
    /// A block of links of one direction and their sources: ends + d.stride, 0 <= d < extent.
    struct Links {
        Ends to, from;
        std::array<int, 3> to_cell, from_cell;  ///< the first ones
        std::array<int, 3> extent;
        std::array<int, 3> c;  ///< into the box
        double w;
        double sign, gain;
        std::array<int, 3> face;  ///< crossed along each axis, or -1
        Vec3 wall_velocity;       ///< where it bounces back
        bool bounces;
        int mouth;  ///< whose dynamic pressure adds to the gain, or -1
    };
    /// A pressure face in a flow with inertia.
    struct Mouth {
        int axis;
        std::array<int, 3> extent;
        std::vector<Ends> ends;       ///< of the links into the first cell
        double rho;                   ///< on the face
        std::vector<double> dynamic;  ///< 3 rho u_n^2 on the face, per cell; half of it where fluid enters

        std::size_t index(int x, int y, int z) const
        {
            const int at[3] = {x, y, z};
            const int b = (axis + 1) % 3, c = (axis + 2) % 3;
            return static_cast<std::size_t>(at[c]) * extent[b] + at[b];
        }
    };
    template <class Body>
    void for_links(const Links& links, Body body) const;
    double dynamic_gain(const Links& links, int x, int y, int z) const;
    template <class T>
    void see_dynamic_pressure(T* f, bool odd);
    void share(const Links& links, const Vec3& place, double out, double in, double drho,
               std::array<Passage, 6>& sums) const;

    std::array<Slot, 3> stride_;
    std::array<FaceType, 6> types_;
    std::vector<Links> x_links_, links_;
    std::vector<Mouth> mouths_;
};

}  // namespace lbm
