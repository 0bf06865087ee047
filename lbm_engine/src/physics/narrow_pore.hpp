#pragma once

#include "lattice/vec3.hpp"
#include "physics/rates.hpp"
#include "physics/sphere_kernels.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lbm {

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
 * The cells that a sphere cuts, which count as more solid where other spheres stand opposite across a narrow pore: eps (1 + t (1 - eps)^3) instead of eps.
 *
 * A pressure gradient drives flow through cut cells, which lets fluid slip along surfaces; against the flow of a narrow pore this counts (docs/physics.md,
 * "Narrow pores"). With r and s the places of a cell as seen from the two centres,
 *
 *     t = (A + B h) h / (1 + h^3) (1 - (h / w)^2) min(1, -C r.s / (R1 R2)),   h = (r^2 - R1^2) / (2 R1) + (s^2 - R2^2) / (2 R2)
 *
 * h being the width of the pore and A, B, C and w of the law (Weighting::pores); the last factor fades it out where surfaces stand across to each other. The largest t counts.
 */
class CutCells {
public:
    void clear() { rows_.clear(); }

    /// To be called plane by plane; places are as seen from the centre of the sphere.
    void add(const CutRow& row) { rows_.push_back(row); }

    /// Copies the fractions of all cells added, in this order.
    void gather();

    /// Thickens the gathered cells of a sphere.
    void thicken(const PoreLaw& law, double radius, const std::vector<Opposite>& opposite);

    std::size_t size() const noexcept { return count_; }
    const double* fractions() const noexcept { return fraction_.data(); }

private:
    std::vector<CutRow> rows_;
    std::vector<std::size_t> planes_;  // first cell of each plane
    double lowest_ = 0;                // plane
    std::size_t count_ = 0;
    std::array<Packed<float>, 3> place_;  // from the centre of the sphere
    PackedNumbers fraction_;
    Packed<float> thickening_;
};

}  // namespace lbm
