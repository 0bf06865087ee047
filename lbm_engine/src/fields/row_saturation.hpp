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
 * Populations of the row that will be swept next. Memory is asked for most of them while the cells of this one collide, and for the rest while its solids are served, block by
 * block: it would idle meanwhile. (Solids that do not listen are served half.)
 */
struct RowAhead {
    static constexpr int kFirst = 3, kAll = 6;  ///< asked for while solids speak, and in all before and after the sweep
    std::array<const char*, kAll> populations{};  ///< where they begin
    int block_bytes = 0;                          ///< 0: there is no such row

    [[gnu::always_inline]] void ask_first(int block) const { ask<0, kFirst>(block); }
    [[gnu::always_inline]] void ask_rest(int block) const { ask<kFirst, kAll>(block); }

private:
    template <int begin, int end>
    [[gnu::always_inline]] void ask(int block) const
    {
        if (block_bytes == 0) return;
            // 1: to be written, 2: into the second level.
#pragma GCC unroll 6
        for (int i = begin; i < end; ++i) __builtin_prefetch(populations[i] + block * block_bytes, 1, 2);
    }
};

/**
 * One row of cells as the solids see it: sums of what they say to the cells, then what the collision makes of that, then what the cells answer. One per
 * thread. Only covered blocks mean anything; outside the solids their input is zero. Where all solids are fixed, columns of velocities and weights are not used.
 */
struct RowSaturation {
    enum Column {
        kFraction,               ///< sum of the solids' fractions, above 1 where they overlap; then that of their union
        kStrength,               ///< sum k eps; then kk
        kUs,                     ///< sum eps u_s; then their mean velocity
        kBounce = kUs + 3,       ///< 1 in cells of solids that turn populations round; in blocks that are kWall
        kOmegaMinus,             ///< omega-_c
        kShare,                  ///< 1 / sum eps: a solid takes eps_i times that of the answers
        kForce,                  ///< F_s
        kMomentum = kForce + 3,  ///< eps j_post
        kWeight = kMomentum + 3,  ///< (1 - eps) kk rho
        kColumns
    };

    /// What stands in a block: no solid, solids, or also one that turns populations round (kBounce).
    enum Cover : std::uint8_t { kFluid, kSolids, kWall };

    struct alignas(kBlock * sizeof(double)) Block {  // a vector that crosses no border of a cache line
        double cells[kBlock]{};
    };

    explicit RowSaturation(int nx)
        : stride((padded_to_blocks(nx) / kBlock | 1) * kBlock)
        , values(kColumns * (stride / kBlock))
        , covered(padded_to_blocks(nx) / kBlock, kFluid)
    {
    }
    double* column(int c) noexcept { return values.data()->cells + static_cast<std::size_t>(c) * stride; }
    const double* column(int c) const noexcept { return values.data()->cells + static_cast<std::size_t>(c) * stride; }
    void clear() noexcept
    {
        std::fill(covered.begin(), covered.end(), kFluid);
        ahead.block_bytes = 0;
    }

    std::size_t stride;
    std::vector<Block> values;
    std::vector<std::uint8_t> covered;  ///< per block: a Cover
    RowAhead ahead;
    bool fixed = false;  ///< all solids are at rest, and nobody asks for the weight
    bool heard = true;   ///< solids listen; if not, the cells need not answer
};

/// The saturation of cells, and what a solid takes of their answers.
template <class V>
struct Mixture {
    Saturation<V> saturation;
    V share;  ///< 1 / sum eps; 1 without solids
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
    const V share = one / (fraction > 0 ? fraction : one);
    const V filled = fraction < 1 ? fraction : one;
    const V whole = filled >= 0.5 ? one : zero;
    return {{whole_cells ? whole : filled, strength * (filled * share), {u[0] * share, u[1] * share, u[2] * share}},
            share};
}

}  // namespace lbm
