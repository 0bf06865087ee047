// What a SolidMap says to the rows of the lattice, and hears from them.

#include "fields/solid_map.hpp"

#include "fields/pack.hpp"
#include "lattice/each_isa.hpp"
#include "lattice/wrap.hpp"

#include <algorithm>

namespace lbm {
namespace {

/// 0, 1, 2, ... along the lanes.
template <int W>
[[gnu::always_inline]] inline Pack<W> lanes()
{
    if constexpr (W == 1) return 0;
    else return Pack<W>{0, 1, 2, 3, 4, 5, 6, 7};
}

/// u_s = u0 + (0, spin_y, spin_z) rx along a row.
struct RowVelocity {
    Vec3 u0;
    double spin_y, spin_z;
};

template <int W>
[[gnu::always_inline]] inline void add_solid(RowSaturation& cells, int x, int n, const double* eps, double k, double rx,
                                             const RowVelocity& v)
{
    using C = RowSaturation;
    double* const column[] = {cells.column(C::kFraction) + x, cells.column(C::kStrength) + x, cells.column(C::kUs) + x,
                              cells.column(C::kUs + 1) + x, cells.column(C::kUs + 2) + x};
    for (int i = 0; i < n; i += W) {
        const Pack<W> e = load<W>(eps + i), r = (rx + i) + lanes<W>();
        const Pack<W> term[] = {e, k * e, e * v.u0[0], e * (v.u0[1] + v.spin_y * r), e * (v.u0[2] + v.spin_z * r)};
        for (int c = 0; c < 5; ++c) store<W>(column[c] + i, load<W>(column[c] + i) + term[c]);
    }
}

void cover(RowSaturation& cells, int block)
{
    cells.covered[block] = std::max<std::uint8_t>(cells.covered[block], RowSaturation::kSolids);
}

/// Cells of a wall along the lattice, from x0 on, across the periodic face if need be.
void bounce(RowSaturation& cells, int x0, int n, int nx, const std::uint8_t* bounces)
{
    double* const column = cells.column(RowSaturation::kBounce);
    for (int i = 0; i < n; ++i) {
        const int x = wrap(x0 + i, nx);
        if (!bounces[i]) continue;
        column[x] = 1;
        cells.covered[x / kBlock] = RowSaturation::kWall;
    }
}

/// Adds the answers of n cells to the thirteen sums of a span, in the order of SpanSums: F, rx F, P, rx P (y and z), b, b rx^2.
template <int W>
[[gnu::always_inline]] inline void add_answers(const RowSaturation& cells, int x, int n, const double* eps, double rx,
                                               double* sums)
{
    using C = RowSaturation;
    const auto in = [&](int column, int i) __attribute__((always_inline))
    {
        return load<W>(cells.column(column) + x + i);
    };
    const Pack<W> zero{};
    Pack<W> F[3] = {zero, zero, zero}, xF[3] = {zero, zero, zero}, P[3] = {zero, zero, zero}, xPy = zero, xPz = zero,
            b = zero, bxx = zero;
    for (int i = 0; i < n; i += W) {
        const Pack<W> e = load<W>(eps + i), r = (rx + i) + lanes<W>();
#pragma GCC unroll 3
        for (int d = 0; d < 3; ++d) {
            const Pack<W> f = e * in(C::kForce + d, i);
            F[d] += f;
            xF[d] += r * f;
        }
        const Pack<W> py = e * in(C::kMomentum + 1, i), pz = e * in(C::kMomentum + 2, i);
        P[0] += e * in(C::kMomentum, i);
        P[1] += py;
        P[2] += pz;
        xPy += r * py;
        xPz += r * pz;
        const Pack<W> w = e * in(C::kWeight, i);
        b += w;
        bxx += w * r * r;
    }
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
        sums[d] += sum_lanes(F[d]);
        sums[3 + d] += sum_lanes(xF[d]);
        sums[6 + d] += sum_lanes(P[d]);
    }
    sums[9] += sum_lanes(xPy);
    sums[10] += sum_lanes(xPz);
    sums[11] += sum_lanes(b);
    sums[12] += sum_lanes(bxx);
}

}  // namespace

void SolidMap::prefetch(std::size_t row) const noexcept
{
    const std::size_t rows = row_begin_.size() - 1;
    if (row + 1 < rows)
        for (std::uint32_t e = row_begin_[row + 1]; e < row_begin_[row + 2]; ++e)
            __builtin_prefetch(&solids_[entries_[e].solid].spans[entries_[e].span]);
    if (row < rows)
        for (std::uint32_t e = row_begin_[row]; e < row_begin_[row + 1]; ++e) {
            const MappedSolid& solid = solids_[entries_[e].solid];
            const Span& span = solid.spans[entries_[e].span];
            for (int i = 0; i < span.n; i += kBlock) __builtin_prefetch(solid.fractions.data() + span.fractions + i);
            const char* const sums = reinterpret_cast<const char*>(&solid.sums[entries_[e].span]);
            __builtin_prefetch(sums, 1);
            __builtin_prefetch(sums + sizeof(SpanSums) - 1, 1);
        }
}

LBM_EACH_ISA
void SolidMap::saturate(std::size_t row, RowSaturation& cells) const
{
    for (std::uint32_t e = row_begin_[row]; e < row_begin_[row + 1]; ++e) {
        const MappedSolid& solid = solids_[entries_[e].solid];
        const int s = entries_[e].span;
        const Span& span = solid.spans[s];
        if (span.n == 0) continue;
        const Vec3 &X = solid.solid.geometry.centre, &U = solid.solid.velocity, &W = solid.solid.angular_velocity;
        const int y = solid.y0 + s % solid.ny, z = solid.z0 + s / solid.ny;
        const double ry = y + 0.5 - X[1], rz = z + 0.5 - X[2];
        // u_s = U + W x r along the row.
        const RowVelocity v{{U[0] + W[1] * rz - W[2] * ry, U[1] - W[0] * rz, U[2] + W[0] * ry}, W[2], -W[1]};
        const double* const eps = solid.fractions.data() + span.fractions;
        const double rx = span.x0 + 0.5 - X[0];
        const int x0 = wrap(span.x0, n_[0]);
        if (x0 + span.n <= n_[0]) {
            add_solid<kBlock>(cells, x0, span.n, eps, solid.k, rx, v);
            for (int b = x0 / kBlock; b <= (x0 + span.n - 1) / kBlock; ++b) cover(cells, b);
        } else {
            for (int i = 0; i < span.n; ++i) {
                const int x = wrap(span.x0 + i, n_[0]);
                add_solid<1>(cells, x, 1, eps + i, solid.k, rx + i, v);
                cover(cells, x / kBlock);
            }
        }
        if (!solid.bounce.empty()) bounce(cells, x0, span.n, n_[0], solid.bounce.data() + span.fractions);
    }
}

LBM_EACH_ISA
void SolidMap::collect(std::size_t row, RowSaturation& cells)
{
    for (std::uint32_t e = row_begin_[row]; e < row_begin_[row + 1]; ++e) {
        MappedSolid& solid = solids_[entries_[e].solid];
        const Span& span = solid.spans[entries_[e].span];
        if (span.n == 0) continue;
        const double* const eps = solid.fractions.data() + span.fractions;
        const double rx = span.x0 + 0.5 - solid.solid.geometry.centre[0];
        const int x0 = wrap(span.x0, n_[0]);
        SpanSums& sums = solid.sums[entries_[e].span];
        sums = SpanSums{};
        if (x0 + span.n <= n_[0]) add_answers<kBlock>(cells, x0, span.n, eps, rx, sums.data());
        else
            for (int i = 0; i < span.n; ++i)
                add_answers<1>(cells, wrap(span.x0 + i, n_[0]), 1, eps + i, rx + i, sums.data());
    }
    clear(cells);
}

void SolidMap::clear(RowSaturation& cells) const
{
    for (std::size_t b = 0; b < cells.covered.size(); ++b) {
        if (!cells.covered[b]) continue;
        cells.covered[b] = 0;
        for (int c = RowSaturation::kFraction; c < RowSaturation::kForce; ++c)
            std::fill_n(cells.column(c) + b * kBlock, kBlock, 0.0);
    }
}

SolidSums SolidMap::sums(std::size_t solid) const
{
    const MappedSolid& m = solids_[solid];
    SolidSums total;
    for (int s = 0; s < static_cast<int>(m.sums.size()); ++s) {
        if (m.spans[s].n == 0) continue;
        const double* const F = m.sums[s].data();
        const double *const xF = F + 3, *const P = F + 6, *const xP = F + 9;
        const double b = F[11], bxx = F[12];
        const int y = m.y0 + s % m.ny, z = m.z0 + s / m.ny;
        const double ry = y + 0.5 - m.solid.geometry.centre[1], rz = z + 0.5 - m.solid.geometry.centre[2];
        for (int d = 0; d < 3; ++d) {
            total.force[d] += F[d];
            total.momentum[d] += P[d];
            total.first_moment[0][d] += xF[d];
            total.first_moment[1][d] += ry * F[d];
            total.first_moment[2][d] += rz * F[d];
        }
        total.angular_momentum += Vec3{ry * P[2] - rz * P[1], rz * P[0] - xP[1], xP[0] - ry * P[0]};
        total.coupling += b;
        total.spin_coupling += (2.0 / 3) * (bxx + b * (ry * ry + rz * rz));
    }
    return total;
}

}  // namespace lbm
