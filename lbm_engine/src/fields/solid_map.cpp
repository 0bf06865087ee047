#include "fields/solid_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

void SolidMap::update(const std::vector<LatticeSphere>& spheres, const std::vector<int>& previous)
{
    const bool same_set = spheres.size() == solids_.size() && [&] {
        for (std::size_t s = 0; s < previous.size(); ++s)
            if (previous[s] != static_cast<int>(s)) return false;
        return true;
    }();
    if (!same_set) {
        std::vector<MappedSolid> now(spheres.size());
        for (std::size_t s = 0; s < spheres.size(); ++s)
            if (previous[s] >= 0) now[s] = std::move(solids_[previous[s]]);
        solids_ = std::move(now);
    }
    bool rows_changed = !same_set;
    const auto count = static_cast<std::ptrdiff_t>(spheres.size());
#pragma omp parallel reduction(|| : rows_changed) if (count > 8)
    {
        SphereFraction fraction;
#pragma omp for schedule(dynamic, 8)
        for (std::ptrdiff_t s = 0; s < count; ++s) {
            MappedSolid& solid = solids_[s];
            const bool moved = solid.sphere.centre != spheres[s].centre || solid.sphere.radius != spheres[s].radius;
            solid.sphere = spheres[s];
            if (!moved) continue;
            const std::array<int, 4> rows{solid.y0, solid.ny, solid.z0, solid.nz};
            map(solid, fraction);
            rows_changed = rows_changed || rows != std::array<int, 4>{solid.y0, solid.ny, solid.z0, solid.nz};
        }
    }
    if (rows_changed) list_rows();
}

void SolidMap::map(MappedSolid& solid, SphereFraction& fraction) const
{
    const LatticeSphere& sphere = solid.sphere;
    fraction.evaluate(sphere.centre, sphere.radius);
    const auto& first = fraction.first();
    const auto& count = fraction.count();
    solid.k = weighting_.k(sphere.radius);
    solid.y0 = first[1];
    solid.ny = count[1];
    solid.z0 = first[2];
    solid.nz = count[2];
    solid.spans.clear();
    solid.fractions.clear();
    double outside = 0;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            const double* row = fraction.row(j, k);
            int begin = 0, end = count[0];
            while (begin < end && row[begin] == 0) ++begin;
            while (end > begin && row[end - 1] == 0) --end;
            // Parts of the sphere behind a wall of the box are left out.
            const int y = solid.y0 + j, z = solid.z0 + k;
            const bool row_inside = (periodic_[1] || (y >= 0 && y < n_[1])) && (periodic_[2] || (z >= 0 && z < n_[2]));
            int in_begin = begin, in_end = row_inside ? end : begin;
            if (!periodic_[0]) {
                in_begin = std::clamp(-first[0], in_begin, in_end);
                in_end = std::clamp(n_[0] - first[0], in_begin, in_end);
            }
            for (int i = begin; i < in_begin; ++i) outside += row[i];
            for (int i = in_end; i < end; ++i) outside += row[i];
            solid.spans.push_back(
                {first[0] + in_begin, in_end - in_begin, static_cast<std::uint32_t>(solid.fractions.size())});
            solid.fractions.insert(solid.fractions.end(), row + in_begin, row + in_end);
        }
    const double R = sphere.radius;
    solid.volume = 4 * std::numbers::pi / 3 * R * R * R - outside;
    solid.sums.resize(solid.spans.size());
}

/// Sorts the spans by row; within a row they stand in the order of the solids.
void SolidMap::list_rows()
{
    std::fill(row_begin_.begin(), row_begin_.end(), 0);
    const auto for_spans = [&](auto&& body) {
        for (std::size_t s = 0; s < solids_.size(); ++s) {
            const MappedSolid& solid = solids_[s];
            for (int k = 0, span = 0; k < solid.nz; ++k)
                for (int j = 0; j < solid.ny; ++j, ++span) {
                    const int y = solid.y0 + j, z = solid.z0 + k;
                    const bool inside =
                        (periodic_[1] || (y >= 0 && y < n_[1])) && (periodic_[2] || (z >= 0 && z < n_[2]));
                    if (inside) body(static_cast<std::size_t>(wrap(z, n_[2])) * n_[1] + wrap(y, n_[1]), s, span);
                }
        }
    };
    for_spans([&](std::size_t row, std::size_t, int) { ++row_begin_[row + 1]; });
    for (std::size_t r = 1; r < row_begin_.size(); ++r) row_begin_[r] += row_begin_[r - 1];
    entries_.resize(row_begin_.back());
    std::vector<std::uint32_t> next(row_begin_.begin(), row_begin_.end() - 1);
    for_spans([&](std::size_t row, std::size_t s, int span) {
        entries_[next[row]++] = {static_cast<std::int32_t>(s), span};
    });
}

/// Calls body(x in the box, first, last, shift) for the pieces of a span that lie side by side in the box.
template <class Body>
void SolidMap::for_cells(const Span& span, Body body) const
{
    for (int done = 0; done < span.n;) {
        const int x = wrap(span.x0 + done, n_[0]);
        const int piece = std::min(span.n - done, n_[0] - x);
        body(x, done, piece);
        done += piece;
    }
}

void SolidMap::saturate(std::size_t row, RowSaturation& cells) const
{
    double* const sum = cells.column(RowSaturation::kEpsilonSum);
    double* const strength = cells.column(RowSaturation::kStrength);
    double* const us = cells.column(RowSaturation::kUs);
    const std::size_t stride = cells.stride;
    for (std::uint32_t e = row_begin_[row]; e < row_begin_[row + 1]; ++e) {
        const MappedSolid& solid = solids_[entries_[e].solid];
        const int s = entries_[e].span;
        const Span& span = solid.spans[s];
        const Vec3 &X = solid.sphere.centre, &U = solid.sphere.velocity, &W = solid.sphere.angular_velocity;
        const int y = solid.y0 + s % solid.ny, z = solid.z0 + s / solid.ny;
        const double ry = y + 0.5 - X[1], rz = z + 0.5 - X[2];
        const double k = solid.k;
        // u_s = U + W x r along the row.
        const Vec3 u0{U[0] + W[1] * rz - W[2] * ry, U[1] - W[0] * rz, U[2] + W[0] * ry};
        for_cells(span, [&](int x, int done, int piece) {
            const double* const eps = solid.fractions.data() + span.fractions + done;
            const double rx = span.x0 + done + 0.5 - X[0];
            for (int i = 0; i < piece; ++i) {
                sum[x + i] += eps[i];
                strength[x + i] += k * eps[i];
                us[x + i] += eps[i] * u0[0];
                us[stride + x + i] += eps[i] * (u0[1] + W[2] * (rx + i));
                us[2 * stride + x + i] += eps[i] * (u0[2] - W[1] * (rx + i));
            }
            for (int b = x / kBlock; b <= (x + piece - 1) / kBlock; ++b) cells.covered[b] = 1;
        });
    }
    double* const epsilon = cells.column(RowSaturation::kEpsilon);
    for (std::size_t b = 0; b < cells.covered.size(); ++b) {
        if (!cells.covered[b]) continue;
        for (std::size_t x = b * kBlock; x < (b + 1) * kBlock; ++x) {
            // Where solids overlap the fractions fill the cell at most once; the mean velocity is weighted by them.
            const double total = sum[x];
            const double inverse = 1 / (total > 0 ? total : 1);
            epsilon[x] = std::min(total, 1.0);
            strength[x] *= epsilon[x] * inverse;
            for (int d = 0; d < 3; ++d) us[d * stride + x] *= inverse;
        }
    }
}

void SolidMap::collect(std::size_t row, RowSaturation& cells)
{
    const double* const sum = cells.column(RowSaturation::kEpsilonSum);
    const double* const epsilon = cells.column(RowSaturation::kEpsilon);
    const double* const force = cells.column(RowSaturation::kForce);
    const double* const momentum = cells.column(RowSaturation::kMomentum);
    const double* const weight = cells.column(RowSaturation::kWeight);
    const std::size_t stride = cells.stride;
    for (std::uint32_t e = row_begin_[row]; e < row_begin_[row + 1]; ++e) {
        MappedSolid& solid = solids_[entries_[e].solid];
        const Span& span = solid.spans[entries_[e].span];
        SpanSums t{};
        for_cells(span, [&](int x, int done, int piece) {
            const double* const eps = solid.fractions.data() + span.fractions + done;
            const double rx0 = span.x0 + done + 0.5 - solid.sphere.centre[0];
            for (int i = 0; i < piece; ++i) {
                const double share = eps[i] / (sum[x + i] > 0 ? sum[x + i] : 1);
                const double filled = share * epsilon[x + i];
                const double rx = rx0 + i;
                for (int d = 0; d < 3; ++d) {
                    const double F = share * force[d * stride + x + i];
                    t.F[d] += F;
                    t.xF[d] += rx * F;
                    t.P[d] += filled * momentum[d * stride + x + i];
                }
                t.xP[0] += rx * filled * momentum[stride + x + i];
                t.xP[1] += rx * filled * momentum[2 * stride + x + i];
                const double b = share * (1 - epsilon[x + i]) * weight[x + i];
                t.b += b;
                t.bxx += b * rx * rx;
            }
        });
        solid.sums[entries_[e].span] = t;
    }
    clear(cells);
}

void SolidMap::clear(RowSaturation& cells) const
{
    for (std::size_t b = 0; b < cells.covered.size(); ++b) {
        if (!cells.covered[b]) continue;
        cells.covered[b] = 0;
        for (int c = RowSaturation::kEpsilon; c < RowSaturation::kForce; ++c)
            std::fill_n(cells.column(c) + b * kBlock, kBlock, 0.0);
    }
}

SolidSums SolidMap::sums(std::size_t solid) const
{
    const MappedSolid& m = solids_[solid];
    SolidSums total;
    for (int s = 0; s < static_cast<int>(m.sums.size()); ++s) {
        if (m.spans[s].n == 0) continue;
        const SpanSums& t = m.sums[s];
        const int y = m.y0 + s % m.ny, z = m.z0 + s / m.ny;
        const double ry = y + 0.5 - m.sphere.centre[1], rz = z + 0.5 - m.sphere.centre[2];
        for (int d = 0; d < 3; ++d) {
            total.force[d] += t.F[d];
            total.momentum[d] += t.P[d];
            total.first_moment[0][d] += t.xF[d];
            total.first_moment[1][d] += ry * t.F[d];
            total.first_moment[2][d] += rz * t.F[d];
        }
        total.angular_momentum += Vec3{ry * t.P[2] - rz * t.P[1], rz * t.P[0] - t.xP[1], t.xP[0] - ry * t.P[0]};
        total.coupling += t.b;
        total.spin_coupling += (2.0 / 3) * (t.bxx + t.b * (ry * ry + rz * rz));
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
