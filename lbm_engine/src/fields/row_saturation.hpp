#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lbm {

/// Cells side by side in a row that take the fluid path or the saturated path together.
inline constexpr int kBlock = 8;

constexpr std::size_t padded_to_blocks(std::size_t n) { return (n + kBlock - 1) / kBlock * kBlock; }

/**
 * One row of cells as the saturated collision sees it: what the solids say to the cells, and what the cells answer.
 * One per thread; outside covered blocks the input is zero and the answers are finite and meaningless. A block more than the row
 * holds lets spans be worked on in whole blocks wherever they begin.
 */
struct RowSaturation {
    enum Column {
        kEpsilon,
        kEpsilonSum,
        kStrength,
        kUs,
        kBounce = kUs + 3,  ///< 1 in cells of solids that turn populations round
        kForce,
        kMomentum = kForce + 3,
        kWeight = kMomentum + 3,
        kColumns
    };

    /// What stands in a block: no solid, solids, or also one that turns populations round (kBounce).
    enum Cover : std::uint8_t { kFluid, kSolids, kWall };

    explicit RowSaturation(int nx)
        : stride(padded_to_blocks(nx) + kBlock)
        , values(kColumns * stride, 0.0)
        , covered(stride / kBlock, 0)
    {
    }
    double* column(int c) noexcept { return values.data() + static_cast<std::size_t>(c) * stride; }
    const double* column(int c) const noexcept { return values.data() + static_cast<std::size_t>(c) * stride; }

    std::size_t stride;
    std::vector<double> values;
    std::vector<std::uint8_t> covered;  ///< per block: a Cover
};

}  // namespace lbm
