#pragma once

#include "physics/collision.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lbm {

/// Cells side by side in a row that take the fluid path or the saturated path together.
inline constexpr int kBlock = 8;

constexpr std::size_t padded_to_blocks(std::size_t n) { return (n + kBlock - 1) / kBlock * kBlock; }

/**
 * One row of cells as the solids see it: sums of what they say to the cells, and what the cells answer, per fraction: a solid takes eps_i times that.
 * One per thread. Only covered blocks mean anything; outside the solids their input is zero.
 */
struct RowSaturation {
    enum Column {
        kFraction,                ///< sum of the solids' fractions; above 1 where they overlap
        kStrength,                ///< sum k eps
        kUs,                      ///< sum eps u_s
        kBounce = kUs + 3,        ///< 1 in cells of solids that turn populations round; in blocks that are kWall
        kForce,                   ///< F_s / sum eps
        kMomentum = kForce + 3,   ///< eps j_post / sum eps
        kWeight = kMomentum + 3,  ///< (1 - eps) kk rho / sum eps
        kColumns
    };

    /// What stands in a block: no solid, solids, or also one that turns populations round (kBounce).
    enum Cover : std::uint8_t { kFluid, kSolids, kWall };

    explicit RowSaturation(int nx)
        : stride(padded_to_blocks(nx))
        , values(kColumns * stride, 0.0)
        , covered(stride / kBlock, kFluid)
    {
    }
    double* column(int c) noexcept { return values.data() + static_cast<std::size_t>(c) * stride; }
    const double* column(int c) const noexcept { return values.data() + static_cast<std::size_t>(c) * stride; }
    void clear() noexcept { std::fill(covered.begin(), covered.end(), kFluid); }

    std::size_t stride;
    std::vector<double> values;
    std::vector<std::uint8_t> covered;  ///< per block: a Cover
};

/// The saturation of cells, and what their answers are divided by.
template <class V>
struct Mixture {
    Saturation<V> saturation;
    V per_fraction;  ///< 1 / sum eps; 1 without solids
};

/**
 * From the sums over the solids in cells. Where solids overlap, fractions fill a cell at most once; velocity and strength are means weighted by them.
 * @param whole_cells  cells are solid or fluid, whichever they are more (for bounce-back)
 */
template <class V>
[[gnu::always_inline]] inline Mixture<V> mixture(const V& fraction, const V& strength, const V (&u)[3],
                                                 bool whole_cells)
{
    const V one = V{} + 1.0, zero = V{};
    const V per_fraction = one / (fraction > 0 ? fraction : one);
    const V filled = fraction < 1 ? fraction : one;
    const V whole = filled >= 0.5 ? one : zero;
    return {{whole_cells ? whole : filled,
             strength * (filled * per_fraction),
             {u[0] * per_fraction, u[1] * per_fraction, u[2] * per_fraction}},
            per_fraction};
}

}  // namespace lbm
