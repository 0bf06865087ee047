#pragma once

#include "lattice/vec3.hpp"
#include "physics/sphere_fraction.hpp"

#include <algorithm>
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
 * A sphere opposite another one across a pore, as seen from the centre of that one. The distance of a point r from it is taken as (s^2 - R2^2) / (2 R2), s being the
 * point as seen from its own centre, or
 *
 *     r^2 / (2 R2) - r.towards + distance
 */
struct Opposite {
    Vec3 towards{};        ///< its centre over its radius
    double curvature = 0;  ///< 1 / R2
    double distance = 0;   ///< of the centre from which it is seen
    bool operator==(const Opposite&) const = default;

    Opposite(const Vec3& centre, double radius)
        : towards((1 / radius) * centre)
        , curvature(1 / radius)
        , distance((dot(centre, centre) - radius * radius) / (2 * radius))
    {
    }
};

/// Distance between the centres of two spheres beyond which no pore between them is narrow.
[[nodiscard]] double narrow_reach(double radius1, double radius2);

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
     * Counts the cells that a sphere cuts as more solid where other spheres stand opposite across a narrow pore: eps (1 + t (1 - eps)) instead of eps.
     *
     * A pressure gradient drives flow through cut cells, too much by a volume that does not depend on the width of the pore; against the flow of a narrow one this
     * counts (docs/physics.md, "Narrow pores"). With r and s the places of a cell as seen from the two centres,
     *
     *     t = 3.7 / (h^2 + 4) (1 - h / w) min(1, -2 r.s / (R1 R2)),   h = (r^2 - R1^2) / (2 R1) + (s^2 - R2^2) / (2 R2),   w = min(R1, R2)
     *
     * h being the width of the pore; the last factor fades it out where surfaces stand across to each other. The largest t counts.
     *
     * @return what was added inside the lattice [cells]
     */
    double thicken(const SolidGeometry& sphere, const std::vector<Opposite>& opposite);

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
    void make_own();
    void gather_ring(const Vec3& centre, double inner, double outer);
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
    struct {
        std::array<std::vector<std::int16_t>, 3> cell;  // x, y, z of count()
        std::array<std::vector<double>, 3> centre;      // from that of the sphere
        std::vector<double> thickening;
        std::vector<int> planes;               // first cell of each plane, and an end
        std::vector<double> reach, hollow;     // of rows of a plane
    } cut_;                                    // cells, while thickening
    std::array<std::vector<double>, 3> axis_;  // while evaluating a box along the axes
};

}  // namespace lbm
