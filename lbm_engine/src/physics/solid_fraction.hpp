#pragma once

#include "lattice/vec3.hpp"
#include "physics/sphere_fraction.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lbm {

/// Shape and place of a solid, in lattice units: cell i reaches from i to i + 1.
struct SolidGeometry {
    Shape shape = Shape::sphere;
    double radius = 0;
    Vec3 half_extents{};
    Mat3 axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< of a box, unit vectors
    int axis = 0;                                  ///< of a pipe
    Vec3 centre{};                                 ///< wrapped into the box in periodic directions
    bool operator==(const SolidGeometry&) const = default;
};

/// A sphere near another one: the image that is near.
struct NearSphere {
    Vec3 centre{};
    double radius = 0;
    bool operator==(const NearSphere&) const = default;
};

/**
 * How much of the fluid in a gap between two spheres counts as fluid. In a gap of less than about two cells the lattice lets too much through, since no cell sees both surfaces for what they are.
 * Counting the fluid of width `gap` as `passage` times itself gives narrow gaps the permeability gap^2 / 12, wherever they lie in their cells (docs/physics.md).
 *
 * @param gap  [cells]
 * @return 0 at contact, 1 from kNarrowGap on
 */
inline constexpr double kNarrowGap = 1.9;
[[nodiscard]] double passage(double gap);

/**
 * Solid fractions of the cells that a solid touches, inside a lattice.
 *
 * Spheres, boxes along the axes and pipes are exact to round-off. Of a solid that overlaps others of its rigid body, and of a rotated box, cells that
 * surfaces cut are integrated along 8 x 8 lines (error of such a cell about 1e-3, with either sign).
 */
class SolidFraction {
public:
    SolidFraction(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic) : n_(cells), periodic_(periodic)
    {
    }

    /**
     * Evaluates the fractions. Buffers are kept from call to call.
     * @param others  solids whose volume is taken off, for the union of overlapping solids; in any periodic image
     */
    void evaluate(const SolidGeometry& solid, const std::vector<SolidGeometry>& others = {});

    /**
     * Raises the fractions of a sphere that was evaluated where others are near: each of two spheres takes from the fluid between them what lies on its side of the
     * middle, as far as it does not count as fluid (passage).
     */
    void fill_gaps(const SolidGeometry& sphere, const std::vector<NearSphere>& near);

    const std::array<int, 3>& first() const noexcept { return first_; }  ///< lowest cell
    const std::array<int, 3>& count() const noexcept { return count_; }  ///< cells
    const double* row(int j, int k) const noexcept  ///< fractions of count()[0] cells in row (j, k)
    {
        return data_ + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
    }

private:
    void sphere(const SolidGeometry& solid);
    void aligned_box(const SolidGeometry& solid, const Vec3& half);
    void rotated_box(const SolidGeometry& solid, const Vec3& half);
    void pipe(const SolidGeometry& solid);
    void leave_out(const SolidGeometry& solid, const std::vector<SolidGeometry>& others);
    void bounds(const Vec3& centre, const Vec3& half);
    void enlarge(const std::array<int, 3>& first, const std::array<int, 3>& count);
    SolidGeometry nearest_image(const SolidGeometry& other, const Vec3& centre) const;
    double* own_row(int j, int k) noexcept
    {
        return own_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
    }

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    std::array<int, 3> first_{}, count_{};
    const double* data_ = nullptr;
    std::size_t line_ = 0;  // between rows
    SphereFraction sphere_;
    std::vector<double> own_;  // fractions that are not a lone sphere's
    struct Raised {
        std::array<int, 3> cell;
        double fraction;
    };
    std::vector<Raised> raised_;               // while filling gaps
    std::vector<double> larger_;               // while moving into a larger box
    std::array<std::vector<double>, 3> axis_;  // while evaluating a box along the axes
};

}  // namespace lbm
