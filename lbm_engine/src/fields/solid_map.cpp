#include "fields/solid_map.hpp"

#include "fields/first_exception.hpp"
#include "fields/populations.hpp"
#include "fields/wall_cells.hpp"
#include "lattice/wrap.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace lbm {
namespace {

/// Goes along an axis from cell i0 on, not wrapped.
struct Walk {
    int n, size;    ///< cells of the lattice, and in a unit
    int cell;       ///< wrapped
    int image = 0;  ///< not wrapped it is cell + image n
    int rest;       ///< cells that are left in the unit after this one
    int unit = 0;   ///< of those passed, from 0 on

    Walk(int i0, int n_, int size_) : n(n_), size(size_), cell(i0)
    {
        // Solids reach into the next image, rarely further.
        if (cell < -n || cell >= 2 * n) {
            cell = wrap(cell, n);
            image = (i0 - cell) / n;
        } else if (cell < 0) {
            cell += n;
            image = -1;
        } else if (cell >= n) {
            cell -= n;
            image = 1;
        }
        rest = size - 1 - cell % size;
    }
    void next()
    {
        if (++cell == n) {
            cell = 0;
            ++image;
            unit += n > size;
            rest = size - 1;
        } else if (rest-- == 0) {
            ++unit;
            rest = size - 1;
        }
    }
};

/// Units in which `count` cells from i0 on lie.
int units_along(int i0, int count, int n, int size)
{
    Walk walk(i0, n, size);
    for (int i = 1; i < count; ++i) walk.next();
    return std::min(walk.unit + 1, (n + size - 1) / size);
}

/// The first n cells of a span; leaves the others, from x = 0 on.
Piece cut(Piece& span)
{
    Piece first = span;
    const int n = first.n, full = std::clamp<int>(n - span.before, 0, span.full);
    first.before = static_cast<std::uint8_t>(std::min<int>(span.before, n));
    first.full = static_cast<std::uint16_t>(full);
    span.fractions += n - full;
    span.before -= first.before;
    span.full -= first.full;
    span.x0 = 0;
    return first;
}

/// Asks for memory that will be read or written soon: what solids have of their own lies scattered, far from the caches.
template <class T>
void prefetch(const std::vector<T>& list)
{
    const char* const begin = reinterpret_cast<const char*>(list.data());
    const char* const end = begin + list.size() * sizeof(T);
    for (const char* line = begin; line < end; line += kCacheLine) __builtin_prefetch(line);
}

}  // namespace

RowUnits::RowUnits(int ny_, int nz_) : ny(ny_), nz(nz_)
{
    constexpr int kUnits = 64;  // at most, about
    planes = (nz + kUnits - 1) / kUnits;
    const int parts = std::max(1, kUnits / nz);
    rows = (ny + parts - 1) / parts;
}

SolidMap::SolidMap(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic,
                   const std::array<bool, 6>& mirrors, const Weighting& weighting, bool thicken)
    : n_(cells)
    , periodic_(periodic)
    , weighting_(weighting)
    , thicken_(thicken)
    , units_(cells[1], cells[2])
    , pores_(cells, periodic, mirrors)
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
    const auto earlier = any_body ? earlier_of_body(solids) : std::vector<std::vector<int>>{};
    bool bodies_changed = !same_set;
    for (std::ptrdiff_t s = 0; s < count && !bodies_changed; ++s)
        bodies_changed = solids_[s].solid.body != solids[s].body;
    moved_.resize(solids.size());
    const auto moved = moved_.data();
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s)
        moved[s] = !(solids_[s].solid.geometry == solids[s].geometry) || solids_[s].solid.body != solids[s].body ||
                   (bodies_changed && solids[s].body >= 0);
    bool boxes_changed = false;
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        if (solids[s].geometry.shape != Shape::box) continue;
        const LatticeSolid& before = solids_[s].solid;
        boxes_changed = boxes_changed || !same_set || moved[s] || before.velocity != solids[s].velocity ||
                        before.angular_velocity != solids[s].angular_velocity;
    }

    bool search = thicken_ && !same_set;
    for (std::ptrdiff_t s = 0; s < count && thicken_ && !search; ++s) search = moved_[s];
    if (search) pores_.search(solids);
    bool spans_changed = !same_set;
    fractions_.resize(std::max<std::size_t>(fractions_.size(), omp_get_max_threads()), {n_, periodic_});
    opposite_.resize(fractions_.size());
    cut_cells_.resize(fractions_.size());
    FirstException out_of_memory;
#pragma omp parallel reduction(|| : spans_changed, boxes_changed) if (count > 8)
    {
        SolidFraction& fraction = fractions_[omp_get_thread_num()];
        std::vector<SolidGeometry> others;
        std::vector<Opposite>& opposite = opposite_[omp_get_thread_num()];
#pragma omp for schedule(dynamic, 8)
        for (std::ptrdiff_t s = 0; s < count; ++s)
            out_of_memory.keep([&] {
                MappedSolid& solid = solids_[s];
                solid.solid = solids[s];
                bool changed = moved[s];
                others.clear();
                if (any_body)
                    for (const int o : earlier[s]) {
                        others.push_back(solids[o].geometry);
                        changed = changed || moved[o];
                    }
                if (search) {
                    pores_.find(s, solids, opposite);
                    changed = changed || opposite != solid.opposite;
                    std::swap(solid.opposite, opposite);
                }
                if (!changed) return;
                map(solid, fraction, cut_cells_[omp_get_thread_num()], others);
                spans_changed = true;
                boxes_changed = boxes_changed || solid.solid.geometry.shape == Shape::box;
            });
    }
    out_of_memory.rethrow();
    if (spans_changed) list_rows();
    if (boxes_changed) mark_walls();
    tell_rows();
}

/// Boxes whose surfaces run along the lattice turn populations round in their outermost cells. All are marked anew when one of them changed.
void SolidMap::mark_walls()
{
    std::vector<const LatticeSolid*> boxes;
    for (const MappedSolid& solid : solids_)
        if (solid.solid.geometry.shape == Shape::box) boxes.push_back(&solid.solid);
    const WallCells walls(n_, periodic_, std::move(boxes));
    for (MappedSolid& solid : solids_) {
        solid.bounce.clear();
        if (solid.solid.geometry.shape != Shape::box || !solid.whole_cells) continue;
        solid.bounce.assign(solid.fractions.size(), 0);
        for (std::size_t i = 0; i + 1 < solid.spans.size(); ++i) {
            const Span& span = solid.spans[i];
            const auto n = static_cast<int>(solid.spans[i + 1].fractions - span.fractions);  // all stored in a box
            const int y = solid.y0 + static_cast<int>(i) % solid.ny, z = solid.z0 + static_cast<int>(i) / solid.ny;
            for (int x = 0; x < n; ++x)
                solid.bounce[span.fractions + x] =
                    solid.fractions[span.fractions + x] == 1 && walls.contain(solid.solid, {span.x0 + x, y, z});
        }
    }
}

/// The curved part of the strength was fitted on spheres. Elsewhere it is left out: for a bore that is the most accurate, too (docs/physics.md).
double SolidMap::k(const SolidGeometry& geometry) const
{
    return weighting_.k(geometry.shape == Shape::sphere ? geometry.radius : std::numeric_limits<double>::infinity());
}

/// Of a row: without cells outside the lattice, and with full cells only where a span can tell of them. Boxes keep all fractions: their walls have marks beside them.
inline RowEnds SolidMap::stored_ends(Shape shape, const SolidFraction& fraction, int j, int k) const
{
    if (!is_row_inside(fraction, j, k)) return {};
    RowEnds ends = fraction.ends(j, k);
    if (!periodic_[0]) {
        const int first = fraction.first()[0];
        for (int* const end : {&ends.begin, &ends.full_begin, &ends.full_end, &ends.end})
            *end = std::clamp(*end, -first, std::max(-first, n_[0] - first));
    }
    constexpr int kMostBefore = std::numeric_limits<std::uint8_t>::max(),
                  kMostFull = std::numeric_limits<std::uint16_t>::max();
    ends.full_end = std::min(ends.full_end, ends.full_begin + kMostFull);
    if (shape == Shape::box || ends.full_begin - ends.begin > kMostBefore || ends.full_begin == ends.full_end)
        ends.full_begin = ends.full_end = ends.begin;
    return ends;
}

void SolidMap::map(MappedSolid& solid, SolidFraction& fraction, CutCells& cut,
                   const std::vector<SolidGeometry>& others) const
{
    const SolidGeometry& geometry = solid.solid.geometry;
    lbm::prefetch(solid.spans);
    lbm::prefetch(solid.fractions);
    fraction.evaluate(geometry, others);
    solid.k = k(geometry);
    measure(solid, fraction, geometry.shape == Shape::sphere && others.empty());
    const auto& first = fraction.first();
    const auto& count = fraction.count();
    solid.y0 = first[1];
    solid.ny = count[1];
    solid.z0 = first[2];
    solid.nz = count[2];
    solid.spans.resize(static_cast<std::size_t>(solid.ny) * solid.nz + 1);
    Span* span = solid.spans.data();
    cut.clear();
    std::uint32_t fractions = kBlock;
    const Vec3 r = Vec3{first[0] + 0.5, first[1] + 0.5, first[2] + 0.5} - geometry.centre;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            const RowEnds ends = stored_ends(geometry.shape, fraction, j, k);
            const int before = ends.full_begin - ends.begin, full = ends.full_end - ends.full_begin,
                      after = ends.end - ends.full_end;
            *span++ = {first[0] + ends.begin, fractions, static_cast<std::uint8_t>(before),
                       static_cast<std::uint16_t>(full)};
            if (ends.begin == ends.end) continue;
            cut.add({fraction.row(j, k) + ends.begin, before, full, after, {r[0] + ends.begin, r[1] + j, r[2] + k}});
            fractions += before + after;
        }
    *span = {0, fractions, 0, 0};
    fractions += kBlock;
    cut.gather();
    solid.filled = solid.opposite.empty() ? 0 : cut.thicken(geometry.radius, solid.opposite);
    // A solid that moves gets a little more than it needs, and should not ask for memory again.
    const bool moves = !solid.fractions.empty();
    if (fractions > solid.fractions.capacity()) solid.fractions.reserve(fractions + (moves ? fractions / 8 : 0));
    solid.fractions.resize(fractions, 0.0);
    std::copy_n(cut.fractions(), cut.size(), solid.fractions.begin() + kBlock);
    solid.units_y = units_along(solid.y0, solid.ny, n_[1], units_.rows);
    solid.units_z = units_along(solid.z0, solid.nz, n_[2], units_.planes);
}

/// Volume inside the lattice, and whether surfaces cut no cell of it.
void SolidMap::measure(MappedSolid& solid, const SolidFraction& fraction, bool lone_sphere) const
{
    const auto& first = fraction.first();
    const auto& count = fraction.count();
    const double R = solid.solid.geometry.radius, whole = 4 * std::numbers::pi / 3 * R * R * R;
    bool within = true;
    for (int d = 0; d < 3; ++d) within = within && is_inside(first[d], d) && is_inside(first[d] + count[d] - 1, d);
    if (lone_sphere && within) {
        solid.volume = whole;
        solid.whole_cells = false;
        return;
    }
    double inside = 0, outside = 0;
    solid.whole_cells = true;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            const double* row = fraction.row(j, k);
            const bool row_inside = is_row_inside(fraction, j, k);
            for (int i = 0; i < count[0]; ++i) {
                if (!row_inside || !is_inside(first[0] + i, 0)) {
                    outside += row[i];
                    continue;
                }
                inside += row[i];
                solid.whole_cells = solid.whole_cells && (row[i] == 1 || row[i] == 0);
            }
        }
    solid.volume = lone_sphere ? whole - outside : inside;
}

/// Calls body(row, piece, wherein x0 and n are still those of the span) for all spans with cells in planes from first to end.
template <class Body>
void SolidMap::for_spans(int first_plane, int end_plane, Body body) const
{
    // Of units that a solid meets again behind a periodic face the sums are the same.
    const auto own = [](int unit, int units) { return unit < units ? unit : unit % units; };
    const auto may_meet = [&](const MappedSolid& solid) {
        const int end = solid.z0 + solid.nz;
        return solid.z0 < 0 || end > n_[2] || (solid.z0 < end_plane && end > first_plane);
    };
    for (std::size_t s = 0; s < solids_.size(); ++s) {
        const MappedSolid& solid = solids_[s];
        if (s + 1 < solids_.size() && may_meet(solids_[s + 1])) lbm::prefetch(solids_[s + 1].spans);
        if (!may_meet(solid)) continue;
        Walk z(solid.z0, n_[2], units_.planes);
        for (int k = 0; k < solid.nz; ++k, z.next()) {
            if (z.cell < first_plane || z.cell >= end_plane) continue;
            const int units_before = own(z.unit, solid.units_z) * solid.units_y;
            const std::size_t plane = static_cast<std::size_t>(z.cell) * n_[1];
            Walk y(solid.y0, n_[1], units_.rows);
            const Span* span = solid.spans.data() + static_cast<std::size_t>(k) * solid.ny;
            for (int j = 0; j < solid.ny; ++j, ++span, y.next()) {
                const auto n = static_cast<std::int32_t>(span[1].fractions - span->fractions) + span->full;
                if (n == 0) continue;
                const int unit = units_before + own(y.unit, solid.units_y);
                body(plane + y.cell, Piece{static_cast<std::int32_t>(s),
                                           span->fractions,
                                           span->x0,
                                           n,
                                           {0, static_cast<std::int8_t>(y.image), static_cast<std::int8_t>(z.image)},
                                           static_cast<std::uint8_t>(unit),
                                           span->before,
                                           span->full});
            }
        }
    }
}

/// Sorts the spans by row, cut at periodic faces; within a row they stand in the order of the solids. Slabs of planes are sorted side by side.
void SolidMap::list_rows()
{
    sums_begin_.resize(solids_.size() + 1);
    sums_begin_[0] = 0;
    for (std::size_t s = 0; s < solids_.size(); ++s)
        sums_begin_[s + 1] = sums_begin_[s] + solids_[s].units_y * solids_[s].units_z;
    sums_.resize(sums_begin_.back());

    constexpr int kSlabs = 16;
    const auto for_slabs = [&](auto&& body) {
#pragma omp parallel for schedule(dynamic)
        for (int slab = 0; slab < kSlabs; ++slab) for_spans(n_[2] * slab / kSlabs, n_[2] * (slab + 1) / kSlabs, body);
    };
    std::fill(row_begin_.begin(), row_begin_.end(), 0);
    const int nx = n_[0];
    const auto is_inside = [nx](const Piece& piece) { return piece.x0 >= 0 && piece.x0 + piece.n <= nx; };
    for_slabs([&](std::size_t row, const Piece& span) {
        if (is_inside(span)) ++row_begin_[row + 1];
        else row_begin_[row + 1] += (wrap(span.x0, nx) + span.n + nx - 1) / nx;
    });
    for (std::size_t r = 1; r < row_begin_.size(); ++r) row_begin_[r] += row_begin_[r - 1];
    pieces_.resize(row_begin_.back());
    row_next_.assign(row_begin_.begin(), row_begin_.end() - 1);
    for_slabs([&](std::size_t row, Piece piece) {
        if (is_inside(piece)) {
            pieces_[row_next_[row]++] = piece;
            return;
        }
        int rest = piece.n;
        const int x0 = wrap(piece.x0, nx);
        piece.image[0] = static_cast<std::int8_t>((piece.x0 - x0) / nx);
        piece.x0 = x0;
        while (rest > 0) {
            piece.n = std::min(rest, nx - piece.x0);
            rest -= piece.n;
            pieces_[row_next_[row]++] = cut(piece);
            ++piece.image[0];
        }
    });
}

void SolidMap::scale_velocities(double s)
{
    for (MappedSolid& solid : solids_) {
        solid.solid.velocity = s * solid.solid.velocity;
        solid.solid.angular_velocity = s * solid.solid.angular_velocity;
    }
    tell_rows();
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

std::size_t SolidMap::memory_bytes() const
{
    const auto bytes_of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    std::size_t bytes = bytes_of(row_begin_) + bytes_of(row_next_) + bytes_of(pieces_) + bytes_of(solids_) +
                        bytes_of(row_solids_) + bytes_of(sums_begin_) + bytes_of(sums_);
    for (const MappedSolid& s : solids_)
        bytes += bytes_of(s.spans) + bytes_of(s.fractions) + bytes_of(s.bounce) + bytes_of(s.opposite);
    return bytes;
}

}  // namespace lbm
