#include "fields/solid_map.hpp"

#include "fields/pack.hpp"
#include "lattice/each_isa.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace lbm {
namespace {

int wrap(int i, int n)
{
    const int r = i % n;
    return r < 0 ? r + n : r;
}

}  // namespace

SolidMap::SolidMap(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, const Weighting& weighting)
    : n_(cells)
    , periodic_(periodic)
    , weighting_(weighting)
    , row_begin_(static_cast<std::size_t>(cells[1]) * cells[2] + 1, 0)
{
}

/// For each solid the solids of its body that come before it, whose volume it must not count again.
std::vector<std::vector<int>> SolidMap::earlier_of_body(const std::vector<LatticeSolid>& solids) const
{
    std::vector<std::vector<int>> earlier(solids.size());
    std::unordered_map<std::int64_t, std::vector<int>> members;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (solids[s].body < 0) continue;
        std::vector<int>& body = members[solids[s].body];
        earlier[s] = body;
        body.push_back(static_cast<int>(s));
    }
    return earlier;
}

void SolidMap::update(const std::vector<LatticeSolid>& solids, const std::vector<int>& previous)
{
    const bool same_set = solids.size() == solids_.size() && [&] {
        for (std::size_t s = 0; s < previous.size(); ++s)
            if (previous[s] != static_cast<int>(s)) return false;
        return true;
    }();
    if (!same_set) {
        std::vector<MappedSolid> now(solids.size());
        for (std::size_t s = 0; s < solids.size(); ++s)
            if (previous[s] >= 0) now[s] = std::move(solids_[previous[s]]);
        solids_ = std::move(now);
    }
    const auto count = static_cast<std::ptrdiff_t>(solids.size());
    const bool any_body = std::any_of(solids.begin(), solids.end(), [](const LatticeSolid& s) { return s.body >= 0; });
    const bool any_box =
        std::any_of(solids.begin(), solids.end(), [](const LatticeSolid& s) { return s.geometry.shape == Shape::box; });
    const auto earlier = any_body ? earlier_of_body(solids) : std::vector<std::vector<int>>{};
    std::vector<std::uint8_t> moved(solids.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s)
        moved[s] = !(solids_[s].solid.geometry == solids[s].geometry) || solids_[s].solid.body != solids[s].body ||
                   (!same_set && solids[s].body >= 0);

    bool rows_changed = !same_set;
#pragma omp parallel reduction(|| : rows_changed) if (count > 8)
    {
        SolidFraction fraction(n_, periodic_);
        std::vector<SolidGeometry> others;
#pragma omp for schedule(dynamic, 8)
        for (std::ptrdiff_t s = 0; s < count; ++s) {
            MappedSolid& solid = solids_[s];
            solid.solid = solids[s];
            bool changed = moved[s];
            others.clear();
            if (any_body)
                for (const int o : earlier[s]) {
                    others.push_back(solids[o].geometry);
                    changed = changed || moved[o];
                }
            if (!changed) continue;
            const std::array<int, 4> rows{solid.y0, solid.ny, solid.z0, solid.nz};
            map(solid, fraction, others);
            rows_changed = rows_changed || rows != std::array<int, 4>{solid.y0, solid.ny, solid.z0, solid.nz};
        }
    }
    if (rows_changed) list_rows();
    if (any_box) mark_walls();
}

/**
 * Boxes whose surface runs along the lattice turn populations round in their outermost cells: the wall then stands exactly half-way to the fluid.
 * Marked anew in every update that has boxes: there are few, and it depends on where the others are.
 */
void SolidMap::mark_walls()
{
    for (std::size_t s = 0; s < solids_.size(); ++s) {
        MappedSolid& solid = solids_[s];
        solid.bounce.clear();
        if (solid.solid.geometry.shape != Shape::box || !solid.whole_cells) continue;
        solid.bounce.assign(solid.fractions.size(), 0);
        for (std::size_t i = 0; i < solid.spans.size(); ++i) {
            const Span& span = solid.spans[i];
            const int y = solid.y0 + static_cast<int>(i) % solid.ny, z = solid.z0 + static_cast<int>(i) / solid.ny;
            for (int x = 0; x < span.n; ++x)
                solid.bounce[span.fractions + x] =
                    solid.fractions[span.fractions + x] == 1 && is_wall_cell(s, {span.x0 + x, y, z});
        }
    }
}

/**
 * Whether a cell of a box may turn populations round: it lies under a surface, and not beside a face of the lattice or another box that moves
 * otherwise. Between two such surfaces in sliding contact populations would grow without bound.
 */
bool SolidMap::is_wall_cell(std::size_t s, const std::array<int, 3>& cell) const
{
    const auto reach = [](const SolidGeometry& g, int d) {  // half of the extent along an axis
        double half = 0;
        for (int a = 0; a < 3; ++a) half += std::abs(g.axes[a][d]) * g.half_extents[a];
        return half;
    };
    // Distance from a cell's centre to the nearest image of a box's centre, along an axis.
    const auto offset = [&](const SolidGeometry& g, int d) {
        double r = cell[d] + 0.5 - g.centre[d];
        if (periodic_[d]) r -= n_[d] * std::round(r / n_[d]);
        return std::abs(r);
    };
    const LatticeSolid& own = solids_[s].solid;
    bool under_surface = false;
    for (int d = 0; d < 3; ++d) {
        if (!periodic_[d] && (cell[d] == 0 || cell[d] == n_[d] - 1)) return false;
        const double half = reach(own.geometry, d);
        const bool fills = periodic_[d] && 2 * half >= n_[d];
        under_surface = under_surface || (!fills && offset(own.geometry, d) > half - 1);
    }
    if (!under_surface) return false;
    for (std::size_t o = 0; o < solids_.size(); ++o) {
        const LatticeSolid& other = solids_[o].solid;
        const bool moves_along = other.velocity == own.velocity && other.angular_velocity == own.angular_velocity;
        if (o == s || other.geometry.shape != Shape::box || moves_along) continue;
        bool beside = true;
        for (int d = 0; d < 3; ++d) beside = beside && offset(other.geometry, d) < reach(other.geometry, d) + 1.5;
        if (beside) return false;
    }
    return true;
}

/// The curved part of the strength was fitted on spheres. Elsewhere it is left out: for a bore that is the most accurate, too (docs/physics.md).
double SolidMap::k(const SolidGeometry& geometry) const
{
    return weighting_.k(geometry.shape == Shape::sphere ? geometry.radius : std::numeric_limits<double>::infinity());
}

void SolidMap::map(MappedSolid& solid, SolidFraction& fraction, const std::vector<SolidGeometry>& others) const
{
    const SolidGeometry& geometry = solid.solid.geometry;
    fraction.evaluate(geometry, others);
    const auto& first = fraction.first();
    const auto& count = fraction.count();
    solid.k = k(geometry);
    solid.y0 = first[1];
    solid.ny = count[1];
    solid.z0 = first[2];
    solid.nz = count[2];
    solid.spans.clear();
    solid.fractions.clear();
    double inside = 0, outside = 0;
    bool whole_cells = true;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            const double* row = fraction.row(j, k);
            int begin = 0, end = count[0];
            while (begin < end && row[begin] == 0) ++begin;
            while (end > begin && row[end - 1] == 0) --end;
            // Parts of a sphere behind a wall of the box are left out.
            const int y = solid.y0 + j, z = solid.z0 + k;
            const bool row_inside = is_inside(y, 1) && is_inside(z, 2);
            int in_begin = begin, in_end = row_inside ? end : begin;
            if (!periodic_[0]) {
                in_begin = std::clamp(-first[0], in_begin, in_end);
                in_end = std::clamp(n_[0] - first[0], in_begin, in_end);
            }
            for (int i = begin; i < in_begin; ++i) outside += row[i];
            for (int i = in_end; i < end; ++i) outside += row[i];
            for (int i = in_begin; i < in_end; ++i) {
                inside += row[i];
                whole_cells = whole_cells && (row[i] == 1 || row[i] == 0);
            }
            solid.spans.push_back(
                {first[0] + in_begin, in_end - in_begin, static_cast<std::uint32_t>(solid.fractions.size())});
            solid.fractions.insert(solid.fractions.end(), row + in_begin, row + in_end);
            solid.fractions.resize(padded_to_blocks(solid.fractions.size()), 0.0);
        }
    const double R = geometry.radius;
    const bool lone_sphere = geometry.shape == Shape::sphere && others.empty();
    solid.volume = lone_sphere ? 4 * std::numbers::pi / 3 * R * R * R - outside : inside;
    solid.whole_cells = whole_cells;
    solid.sums.resize(solid.spans.size());
}

/// Sorts the spans by row; within a row they stand in the order of the solids. Slabs of planes are sorted side by side.
void SolidMap::list_rows()
{
    constexpr int kSlabs = 16;
    const auto for_spans = [&](auto&& body) {
#pragma omp parallel for schedule(dynamic)
        for (int slab = 0; slab < kSlabs; ++slab) {
            const int first = n_[2] * slab / kSlabs, last = n_[2] * (slab + 1) / kSlabs;
            for (std::size_t s = 0; s < solids_.size(); ++s) {
                const MappedSolid& solid = solids_[s];
                for (int k = 0; k < solid.nz; ++k) {
                    const int plane = wrap(solid.z0 + k, n_[2]);
                    if (plane < first || plane >= last || !is_inside(solid.z0 + k, 2)) continue;
                    for (int j = 0; j < solid.ny; ++j)
                        if (is_inside(solid.y0 + j, 1))
                            body(static_cast<std::size_t>(plane) * n_[1] + wrap(solid.y0 + j, n_[1]), s,
                                 k * solid.ny + j);
                }
            }
        }
    };
    std::fill(row_begin_.begin(), row_begin_.end(), 0);
    for_spans([&](std::size_t row, std::size_t, int) { ++row_begin_[row + 1]; });
    for (std::size_t r = 1; r < row_begin_.size(); ++r) row_begin_[r] += row_begin_[r - 1];
    entries_.resize(row_begin_.back());
    row_next_.assign(row_begin_.begin(), row_begin_.end() - 1);
    for_spans([&](std::size_t row, std::size_t s, int span) {
        entries_[row_next_[row]++] = {static_cast<std::int32_t>(s), span};
    });
}

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

void SolidMap::scale_velocities(double s) noexcept
{
    for (MappedSolid& solid : solids_) {
        solid.solid.velocity = s * solid.solid.velocity;
        solid.solid.angular_velocity = s * solid.solid.angular_velocity;
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

std::size_t SolidMap::memory_bytes() const
{
    std::size_t bytes = row_begin_.capacity() * sizeof(row_begin_[0]) + entries_.capacity() * sizeof(RowEntry);
    for (const MappedSolid& s : solids_)
        bytes += sizeof(s) + s.spans.capacity() * sizeof(Span) + s.fractions.capacity() * sizeof(double) +
                 s.sums.capacity() * sizeof(SpanSums);
    return bytes;
}

}  // namespace lbm
