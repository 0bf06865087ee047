// The rows of the lattice as solids see them: listing their pieces, what the solids say to them, and hear from them.

#include "fields/prefetch.hpp"
#include "fields/solid_map.hpp"
#include "lattice/wrap.hpp"

#include <algorithm>
#include <utility>

namespace lbm {
namespace {

/// Of units that a solid meets again behind a periodic face the sums are the same.
int own_unit(int unit, int units) { return unit < units ? unit : unit % units; }

/// The first n cells of a piece, or all; leaves the others, from x = 0 on.
Piece cut(Piece& piece, int n)
{
    Piece first = piece;
    first.n = std::min(n, piece.n);
    const int full = std::clamp<int>(first.n - piece.before, 0, piece.full);
    first.before = static_cast<std::uint8_t>(std::min<int>(piece.before, first.n));
    first.full = static_cast<std::uint16_t>(full);
    piece.fractions += first.n - full;
    piece.before -= first.before;
    piece.full -= first.full;
    piece.n -= first.n;
    piece.x0 = 0;
    return first;
}

}  // namespace

/// Calls body(row, span, row as the solid sees it) for all spans with cells in the rows visited.
template <class Body>
void SolidMap::for_spans(const std::vector<Visit>& visits, Body body) const
{
    constexpr std::ptrdiff_t kAhead = 3;
    const Visit* const end = visits.data() + visits.size();
    for (const Visit* visit = visits.data(); visit != end; ++visit) {
        if (end - visit > kAhead)
            prefetch_memory(visit[kAhead].spans, visit[kAhead].spans + visit[kAhead].planes * visit[kAhead].next_plane);
        for (int k = 0; k < visit->planes; ++k) {
            const Span* const span = visit->spans + static_cast<std::ptrdiff_t>(k) * visit->next_plane;
            const std::size_t row = visit->row + static_cast<std::size_t>(k) * n_[1];
            for (int j = 0; j < visit->rows; ++j)
                if (span[j].n > 0) body(row + j, span[j], visit->seen);
        }
    }
}

/// Sorts the spans by row, cut at periodic faces; within a row they stand in the order of the solids.
void SolidMap::list_rows()
{
    std::size_t pieces = 0;
    sums_begin_.resize(solids_.size() + 1);
    sums_begin_[0] = 0;
    visits_.resize(units_.count());
    for (auto& visits : visits_) visits.clear();
    for (std::size_t s = 0; s < solids_.size(); ++s) {
        const MappedSolid& solid = solids_[s];
        pieces += solid.pieces;
        sums_begin_[s + 1] = sums_begin_[s] + solid.units_y * solid.units_z;
        for (Walk z(solid.z0, solid.nz, n_[2], units_.planes); z.left > 0; z.next())
            for (Walk y(solid.y0, solid.ny, n_[1], units_.rows); y.left > 0; y.next()) {
                const int unit = own_unit(z.passed, solid.units_z) * solid.units_y + own_unit(y.passed, solid.units_y);
                visits_[z.unit() * units_.along_y() + y.unit()].push_back(
                    {{static_cast<std::int32_t>(s),
                      {0, static_cast<std::int8_t>(y.image), static_cast<std::int8_t>(z.image)},
                      static_cast<std::uint8_t>(unit)},
                     solid.spans.data() + (solid.nz - z.left) * solid.ny + (solid.ny - y.left),
                     y.count(),
                     z.count(),
                     solid.ny,
                     static_cast<std::uint32_t>(z.cell * n_[1] + y.cell)});
            }
    }
    sums_.resize(sums_begin_.back());
    pieces_.resize(pieces);
    std::atomic<std::uint32_t> listed{0};
#pragma omp parallel for schedule(dynamic) if (solids_.size() > 8)
    for (int unit = 0; unit < units_.count(); ++unit) list_rows_of(unit, listed);
}

/// @param listed  pieces, of this and other units
void SolidMap::list_rows_of(int unit, std::atomic<std::uint32_t>& listed)
{
    for_rows_of(units_, unit, [&](std::size_t row, int, int) { row_end_[row] = 0; });
    const int nx = n_[0];
    std::uint32_t count = 0;
    for_spans(visits_[unit], [&](std::size_t row, const Span& span, const RowOfSolid&) {
        const std::uint32_t pieces = pieces_of(span, nx);
        row_end_[row] += pieces;
        count += pieces;
    });
    std::uint32_t next = listed.fetch_add(count);
    for_rows_of(units_, unit, [&](std::size_t row, int, int) {
        row_begin_[row] = next;
        next += std::exchange(row_end_[row], next);
    });
    for_spans(visits_[unit], [&](std::size_t row, const Span& span, const RowOfSolid& seen) {
        Piece* piece = &pieces_[row_end_[row]];
        if (span.x0 >= 0 && span.x0 + span.n <= nx) {
            static_cast<Span&>(*piece) = span;
            static_cast<RowOfSolid&>(*piece) = seen;
            ++row_end_[row];
            return;
        }
        Piece rest{span, seen};
        rest.x0 = wrap(span.x0, nx);
        rest.image[0] = static_cast<std::int8_t>((span.x0 - rest.x0) / nx);
        for (; rest.n > 0; ++rest.image[0], ++row_end_[row]) *piece++ = cut(rest, nx - rest.x0);
    });
}

void SolidMap::tell_rows()
{
    row_solids_.resize(solids_.size());
    all_fixed_ = std::all_of(solids_.begin(), solids_.end(), [](const MappedSolid& m) { return m.solid.fixed; });
    const auto count = static_cast<std::ptrdiff_t>(solids_.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        const MappedSolid& m = solids_[s];
        row_solids_[s] = {m.solid.geometry.centre,
                          m.solid.velocity,
                          m.solid.angular_velocity,
                          m.k,
                          sums_begin_[s],
                          m.fractions.data(),
                          m.bounce.empty() ? nullptr : m.bounce.data()};
    }
}

PiecesOfRow SolidMap::pieces(std::size_t row) const noexcept
{
    return {pieces_.data() + row_begin_[row], pieces_.data() + row_end_[row], row_solids_.data(), n_,
            static_cast<int>(row % n_[1]),    static_cast<int>(row / n_[1]),  all_fixed_};
}

void SolidMap::prefetch(std::size_t row, bool heard) const noexcept
{
    if (row == row_begin_.size()) return;
    const Piece* const next = pieces_.data() + row_end_[row];  // of the row after it, about as many
    for (const Piece* line = next; line < next + (row_end_[row] - row_begin_[row]); line += kCacheLine / sizeof(Piece))
        __builtin_prefetch(line);
    for (std::uint32_t p = row_begin_[row]; p < row_end_[row]; ++p) {
        const Piece& piece = pieces_[p];
        const RowSolid& solid = row_solids_[piece.solid];
        if (heard) {
            const PieceSums& sums = sums_[solid.sums + piece.unit];
            for (const double* const lanes : {sums.plain, sums.x, sums.y, sums.z}) __builtin_prefetch(lanes, 1);
        }
        const double* const fractions = solid.fractions + piece.fractions;
        const int stored = piece.n - piece.full;
        // Blocks are read whole: up to kBlock - 1 beyond the end.
        for (int i = 0; i < stored + kBlock - 1; i += kBlock) __builtin_prefetch(fractions + i);
        __builtin_prefetch(fractions + stored + kBlock - 2);
    }
}

void SolidMap::saturate(std::size_t row, RowSaturation& cells) const
{
    static const auto kernel = solid_row_kernels().saturate;
    kernel(pieces(row), cells);
}

void SolidMap::collect(std::size_t row, const RowSaturation& cells)
{
    static const auto kernel = solid_row_kernels().collect;
    kernel(pieces(row), cells, sums_.data());
}

void SolidMap::clear_sums()
{
    const auto count = static_cast<std::ptrdiff_t>(sums_.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t i = 0; i < count; ++i) sums_[i] = PieceSums{};
}

SolidSums SolidMap::sums(std::size_t solid) const
{
    PieceSums s{};
    for (std::uint32_t i = sums_begin_[solid]; i < sums_begin_[solid + 1]; ++i)
        for (int l = 0; l < 8; ++l) {
            s.plain[l] += sums_[i].plain[l];
            s.x[l] += sums_[i].x[l];
            s.y[l] += sums_[i].y[l];
            s.z[l] += sums_[i].z[l];
        }
    SolidSums total;
    for (int d = 0; d < 3; ++d) {
        total.force[d] = s.plain[d];
        total.momentum[d] = s.plain[3 + d];
        total.first_moment[0][d] = s.x[d];
        total.first_moment[1][d] = s.y[d];
        total.first_moment[2][d] = s.z[d];
    }
    const double xPy = s.x[3], xPz = s.x[4];
    total.angular_momentum = {s.y[5] - s.z[4], s.z[3] - xPz, xPy - s.y[3]};
    total.coupling = s.plain[6];
    total.spin_coupling = (2.0 / 3) * s.plain[7];
    return total;
}

}  // namespace lbm
