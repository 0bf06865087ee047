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

/// Goes along an axis, over cells that need not be wrapped, unit by unit.
struct Walk {
    int left;        ///< cells, from this one on
    int n, size;     ///< cells of the lattice, and in a unit
    int cell;        ///< wrapped
    int image = 0;   ///< not wrapped it is cell + image n
    int passed = 0;  ///< units, a single one that is met again not counted

    Walk(int first, int count, int n_, int size_) : left(count), n(n_), size(size_), cell(first)
    {
        // Solids reach into the next image, rarely further.
        if (cell < -n || cell >= 2 * n) {
            cell = wrap(cell, n);
            image = (first - cell) / n;
        } else if (cell < 0) {
            cell += n;
            image = -1;
        } else if (cell >= n) {
            cell -= n;
            image = 1;
        }
    }
    int unit() const { return cell / size; }
    /// Cells from this one on in its unit and image.
    int count() const { return std::min({left, size - cell % size, n - cell}); }
    void next()
    {
        const int cells = count();
        left -= cells;
        cell += cells;
        if (cell < n) {
            ++passed;
            return;
        }
        cell = 0;
        ++image;
        passed += n > size;
    }
};

/// Units in which `count` cells from `first` on lie.
int units_along(int first, int count, int n, int size)
{
    int units = 1;
    for (Walk walk(first, count, n, size); walk.left > 0; walk.next()) units = walk.passed + 1;
    return std::min(units, (n + size - 1) / size);
}

/// Of units that a solid meets again behind a periodic face the sums are the same.
int own_unit(int unit, int units) { return unit < units ? unit : unit % units; }

/// Into which periodic faces cut a span.
inline std::uint32_t pieces_of(const Span& span, int nx)
{
    if (span.x0 >= 0 && span.x0 + span.n <= nx) return 1;
    return (wrap(span.x0, nx) + span.n + nx - 1) / nx;
}

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

/// Asks for memory that will be read or written soon: what solids have of their own lies scattered, far from the caches.
template <class T>
void prefetch(const T* begin, const T* end)
{
    for (auto line = reinterpret_cast<const char*>(begin); line < reinterpret_cast<const char*>(end);
         line += kCacheLine)
        __builtin_prefetch(line);
}
template <class T>
void prefetch(const std::vector<T>& list)
{
    prefetch(list.data(), list.data() + list.size());
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
    , row_begin_(static_cast<std::size_t>(cells[1]) * cells[2], 0)
    , row_end_(row_begin_)
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
        for (std::size_t i = 0; i < solid.spans.size(); ++i) {
            const Span& span = solid.spans[i];  // all fractions of a box are stored
            const int y = solid.y0 + static_cast<int>(i) % solid.ny, z = solid.z0 + static_cast<int>(i) / solid.ny;
            for (int x = 0; x < span.n; ++x)
                solid.bounce[span.fractions + x] =
                    solid.fractions[span.fractions + x] == 1 && walls.contain(solid.solid, {span.x0 + x, y, z});
        }
    }
}

/// The curved part of the strength was fitted on spheres. Elsewhere planes decide (docs/physics.md).
double SolidMap::k(const SolidGeometry& geometry) const
{
    return geometry.shape == Shape::sphere ? weighting_.k(geometry.radius) : weighting_.k_other;
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
    solid.spans.resize(static_cast<std::size_t>(solid.ny) * solid.nz);
    Span* span = solid.spans.data();
    cut.clear();
    std::uint32_t fractions = kBlock;
    solid.pieces = 0;
    const Vec3 r = Vec3{first[0] + 0.5, first[1] + 0.5, first[2] + 0.5} - geometry.centre;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            const RowEnds ends = stored_ends(geometry.shape, fraction, j, k);
            const int before = ends.full_begin - ends.begin, full = ends.full_end - ends.full_begin,
                      after = ends.end - ends.full_end;
            *span++ = {first[0] + ends.begin, ends.end - ends.begin, fractions, static_cast<std::uint16_t>(full),
                       static_cast<std::uint8_t>(before)};
            if (ends.begin == ends.end) continue;
            solid.pieces += pieces_of(span[-1], n_[0]);
            cut.add({fraction.row(j, k) + ends.begin, before, full, after, {r[0] + ends.begin, r[1] + j, r[2] + k}});
            fractions += before + after;
        }
    fractions += kBlock;
    cut.gather();
    if (!solid.opposite.empty()) cut.thicken(weighting_.pores, geometry.radius, solid.opposite);
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

/// Calls body(row, span, row as the solid sees it) for all spans with cells in the rows visited.
template <class Body>
void SolidMap::for_spans(const std::vector<Visit>& visits, Body body) const
{
    constexpr std::ptrdiff_t kAhead = 3;
    const Visit* const end = visits.data() + visits.size();
    for (const Visit* visit = visits.data(); visit != end; ++visit) {
        if (end - visit > kAhead)
            lbm::prefetch(visit[kAhead].spans, visit[kAhead].spans + visit[kAhead].planes * visit[kAhead].next_plane);
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
    std::size_t bytes = bytes_of(row_begin_) + bytes_of(row_end_) + bytes_of(pieces_) + bytes_of(solids_) +
                        bytes_of(row_solids_) + bytes_of(sums_begin_) + bytes_of(sums_);
    for (const auto& visits : visits_) bytes += bytes_of(visits);
    for (const MappedSolid& s : solids_)
        bytes += bytes_of(s.spans) + bytes_of(s.fractions) + bytes_of(s.bounce) + bytes_of(s.opposite);
    return bytes;
}

}  // namespace lbm
