// What solids say to a row and hear from it, compiled once per instruction set: define LBM_ISA (a namespace) before including.

#include "fields/solid_row.hpp"
#include "lattice/pack.hpp"

#include <algorithm>

namespace lbm::LBM_ISA {
namespace {

using Cells = Pack<kBlock>;
constexpr Cells kLanes{0, 1, 2, 3, 4, 5, 6, 7};

/// Calls body(block, eps, at) for the blocks of a row in which a piece lies: its fractions, 0 in the other cells, and how far these are from its first.
template <class Body>
[[gnu::always_inline]] inline void for_blocks(const Piece& piece, const double* fractions, Body body)
{
    const Cells zero{}, one = zero + 1.0, end = zero + piece.n;
    const int full_end = piece.before + piece.full;
    for (int block = piece.x0 / kBlock; block * kBlock < piece.x0 + piece.n; ++block) {
        const int first = block * kBlock - piece.x0;
        const Cells at = first + kLanes;
        // Where a side of the full cells is out of sight, its fractions are not asked for far from the piece's.
        const Cells before = load<kBlock>(fractions + std::min<int>(first, piece.before));
        const Cells after = load<kBlock>(fractions + std::max(first - piece.full, -kBlock));
        Cells eps = at < zero + full_end ? one : after;
        eps = at < zero + piece.before ? before : eps;
        eps = at < zero ? zero : eps;
        eps = at < end ? eps : zero;
        body(block, eps, at);
    }
}

/// The eight lanes are the sums over the lanes of eight packs, by neighbours: one order for all instruction sets.
[[gnu::always_inline]] inline Cells sums_over_lanes(const Cells (&v)[8])
{
    const auto pairs = [](const Cells& a, const Cells& b) __attribute__((always_inline))
    {
        return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) +
               __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    };
    const auto fours = [](const Cells& a, const Cells& b) __attribute__((always_inline))
    {
        return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
               __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    const Cells a = fours(pairs(v[0], v[1]), pairs(v[2], v[3])), b = fours(pairs(v[4], v[5]), pairs(v[6], v[7]));
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
}

[[gnu::always_inline]] inline void add(double* sums, const Cells& terms)
{
    store<kBlock>(sums, load<kBlock>(sums) + terms);
}

/// Cells of a wall along the lattice.
void bounce(RowSaturation& cells, int x0, int n, const std::uint8_t* bounces)
{
    double* const column = cells.column(RowSaturation::kBounce);
    for (int i = 0; i < n; ++i) {
        if (!bounces[i]) continue;
        const int x = x0 + i, block = x / kBlock;
        if (cells.covered[block] != RowSaturation::kWall) std::fill_n(column + block * kBlock, kBlock, 0.0);
        cells.covered[block] = RowSaturation::kWall;
        column[x] = 1;
    }
}

/// Of the centre of a piece's first cell, from its solid's centre.
[[gnu::always_inline]] inline Vec3 from_centre(const Piece& piece, const PiecesOfRow& row)
{
    const Vec3& X = row.solids[piece.solid].centre;
    return {piece.x0 + piece.image[0] * row.n[0] + 0.5 - X[0], row.y + piece.image[1] * row.n[1] + 0.5 - X[1],
            row.z + piece.image[2] * row.n[2] + 0.5 - X[2]};
}

template <bool fixed>
[[gnu::always_inline]] inline void saturate_row(const PiecesOfRow& row, RowSaturation& cells)
{
    using C = RowSaturation;
    double* const columns = cells.column(C::kFraction);
    for (const Piece* p = row.begin; p != row.end; ++p) {
        const Piece& piece = *p;
        const RowSolid& solid = row.solids[piece.solid];
        const Vec3 r = from_centre(piece, row);
        const Vec3 &U = solid.velocity, &W = solid.angular_velocity;
        // u_s = U + W x r, from the first cell on
        const Vec3 u0{U[0] + W[1] * r[2] - W[2] * r[1], U[1] + W[2] * r[0] - W[0] * r[2],
                      U[2] + W[0] * r[1] - W[1] * r[0]};
        const auto say = [&](int block, const Cells& e, const Cells& at) __attribute__((always_inline))
        {
            cells.ahead.ask_first(block);
            const bool first = cells.covered[block] == C::kFluid;
            cells.covered[block] = std::max<std::uint8_t>(cells.covered[block], C::kSolids);
            const auto tell = [&](int column, const Cells& term) __attribute__((always_inline))
            {
                double* const sum = columns + column * cells.stride + block * kBlock;
                store<kBlock>(sum, first ? term : load<kBlock>(sum) + term);
            };
            tell(C::kFraction, e);
            tell(C::kStrength, solid.k * e);
            if constexpr (!fixed) {
                tell(C::kUs, e * u0[0]);
                tell(C::kUs + 1, e * (u0[1] + W[2] * at));
                tell(C::kUs + 2, e * (u0[2] - W[1] * at));
            }
        };
        for_blocks(piece, solid.fractions + piece.fractions, say);
        if (solid.bounce) bounce(cells, piece.x0, piece.n, solid.bounce + piece.fractions);
    }
}

template <bool fixed>
[[gnu::always_inline]] inline void collect_row(const PiecesOfRow& row, const RowSaturation& cells,
                                               PieceSums* sums_of_pieces)
{
    using C = RowSaturation;
    const double* const columns = cells.column(0);
    for (const Piece* p = row.begin; p != row.end; ++p) {
        const Piece& piece = *p;
        const RowSolid& solid = row.solids[piece.solid];
        const Vec3 r = from_centre(piece, row);
        const double ryz2 = r[1] * r[1] + r[2] * r[2];
        Cells F[3] = {}, xF[3] = {}, P[3] = {}, xPy{}, xPz{}, b{}, br2{};
        const auto hear = [&](int block, const Cells& e, const Cells& at) __attribute__((always_inline))
        {
            cells.ahead.ask_rest(block);
            const auto in = [&](int column) __attribute__((always_inline))
            {
                return load<kBlock>(columns + column * cells.stride + block * kBlock);
            };
            const Cells rx = r[0] + at, share = e * in(C::kShare);
#pragma GCC unroll 3
            for (int d = 0; d < 3; ++d) {
                const Cells f = share * in(C::kForce + d);
                F[d] += f;
                xF[d] += rx * f;
            }
            const Cells py = share * in(C::kMomentum + 1), pz = share * in(C::kMomentum + 2);
            P[0] += share * in(C::kMomentum);
            P[1] += py;
            P[2] += pz;
            xPy += rx * py;
            xPz += rx * pz;
            if constexpr (!fixed) {
                const Cells w = share * in(C::kWeight);
                b += w;
                br2 += w * (rx * rx + ryz2);
            }
        };
        for_blocks(piece, solid.fractions + piece.fractions, hear);
        const Cells plain = sums_over_lanes({F[0], F[1], F[2], P[0], P[1], P[2], b, br2});
        const Cells x = sums_over_lanes({xF[0], xF[1], xF[2], xPy, xPz, Cells{}, Cells{}, Cells{}});
        PieceSums& sums = sums_of_pieces[solid.sums + piece.unit];
        add(sums.plain, plain);
        add(sums.x, x);
        add(sums.y, r[1] * plain);
        add(sums.z, r[2] * plain);
    }
}

}  // namespace

void saturate(const PiecesOfRow& row, RowSaturation& cells) noexcept
{
    cells.fixed = row.fixed;
    if (row.fixed) saturate_row<true>(row, cells);
    else saturate_row<false>(row, cells);
}

void collect(const PiecesOfRow& row, const RowSaturation& cells, PieceSums* sums) noexcept
{
    if (row.fixed) collect_row<true>(row, cells, sums);
    else collect_row<false>(row, cells, sums);
}

}  // namespace lbm::LBM_ISA
