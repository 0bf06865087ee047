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

/**
 * Solid fractions of the cells that a solid touches, inside a lattice.
 *
 * Exact to round-off. Of a solid that overlaps others of its rigid body, cells in which they meet keep the part that 8 x 8 lines say is left (error of such a cell about
 * 1e-3, with either sign).
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

    const std::array<int, 3>& first() const noexcept { return first_; }  ///< lowest cell
    const std::array<int, 3>& count() const noexcept { return count_; }  ///< cells
    static constexpr int kReadAhead = 8;                                 ///< numbers that may be read after a row
    const double* row(int j, int k) const noexcept  ///< fractions of count()[0] cells in row (j, k)
    {
        return data_ + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
    }
    /// In row (j, k), counted from first()[0].
    RowEnds ends(int j, int k) const noexcept { return ends_[static_cast<std::size_t>(k) * count_[1] + j]; }

private:
    void sphere(const SolidGeometry& solid);
    void aligned_box(const SolidGeometry& solid, const Vec3& half);
    void rotated_box(const SolidGeometry& solid, const Vec3& half);
    void pipe(const SolidGeometry& solid);
    void leave_out(const SolidGeometry& solid, const std::vector<SolidGeometry>& others);
    void bounds(const Vec3& centre, const Vec3& half);
    void make_own();
    void find_ends();
    SolidGeometry nearest_image(const SolidGeometry& other, const Vec3& centre) const;
    double* own_row(int j, int k) noexcept
    {
        return own_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
    }

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    std::array<int, 3> first_{}, count_{};
    const double* data_ = nullptr;
    const RowEnds* ends_ = nullptr;
    std::size_t line_ = 0;  // between rows
    SphereFraction sphere_;
    std::vector<double> own_;  // fractions that are not a lone sphere's
    std::vector<RowEnds> own_ends_;
    std::array<std::vector<double>, 3> axis_;  // while evaluating a box along the axes
};

}  // namespace lbm
