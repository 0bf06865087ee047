#include "fields/solid_map.hpp"

#include "fields/first_exception.hpp"
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
    int n, size;   ///< cells of the lattice, and in a unit
    int cell;      ///< wrapped
    int image;     ///< not wrapped it is cell + image n
    int rest;      ///< cells that are left in the unit after this one
    int unit = 0;  ///< of those passed, from 0 on

    Walk(int i0, int n_, int size_) : n(n_), size(size_), cell(i0), image(0)
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

/// Where the first full cells of a span are, and how many. Boxes keep all fractions: their walls have marks beside them.
std::pair<std::uint8_t, std::uint16_t> full_cells(Shape shape, const double* fractions, int n)
{
    if (shape == Shape::box) return {0, 0};
    const double* const begin = std::find(fractions, fractions + n, 1.0);
    if (begin - fractions > std::numeric_limits<std::uint8_t>::max()) return {0, 0};
    const double* end = begin;
    while (end != fractions + n && *end == 1 && end - begin < std::numeric_limits<std::uint16_t>::max()) ++end;
    return {static_cast<std::uint8_t>(begin - fractions), static_cast<std::uint16_t>(end - begin)};
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

void SolidMap::map(MappedSolid& solid, SolidFraction& fraction, CutCells& cut,
                   const std::vector<SolidGeometry>& others) const
{
    const SolidGeometry& geometry = solid.solid.geometry;
    fraction.evaluate(geometry, others);
    solid.k = k(geometry);
    measure(solid, fraction, geometry.shape == Shape::sphere && others.empty());
    const auto& first = fraction.first();
    const auto& count = fraction.count();
    solid.y0 = first[1];
    solid.ny = count[1];
    solid.z0 = first[2];
    solid.nz = count[2];
    solid.spans.clear();
    solid.spans.reserve(static_cast<std::size_t>(solid.ny) * solid.nz + 1);
    std::size_t fractions = kBlock;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            // Parts of a sphere behind a wall of the box are left out.
            const double* row = fraction.row(j, k);
            int begin = 0, end = is_row_inside(fraction, j, k) ? count[0] : 0;
            if (!periodic_[0]) {
                begin = std::clamp(-first[0], begin, end);
                end = std::clamp(n_[0] - first[0], begin, end);
            }
            while (begin < end && row[begin] == 0) ++begin;
            while (end > begin && row[end - 1] == 0) --end;
            const auto [before, full] = full_cells(geometry.shape, row + begin, end - begin);
            solid.spans.push_back({first[0] + begin, static_cast<std::uint32_t>(fractions), before, full});
            fractions += end - begin - full;
        }
    solid.spans.push_back({0, static_cast<std::uint32_t>(fractions), 0, 0});
    fractions += kBlock;
    // A solid that moves gets a little more than it needs, and should not ask for memory again.
    const bool moves = !solid.fractions.empty();
    if (fractions > solid.fractions.capacity()) solid.fractions.reserve(fractions + (moves ? fractions / 8 : 0));
    solid.fractions.resize(fractions, 0.0);
    for (int k = 0; k < solid.nz; ++k)
        for (int j = 0; j < solid.ny; ++j) {
            const Span* const span = &solid.spans[static_cast<std::size_t>(k) * solid.ny + j];
            const double* const row = fraction.row(j, k) + (span->x0 - first[0]);
            double* const stored = solid.fractions.data() + span->fractions;
            const std::size_t count = span[1].fractions - span->fractions;
            std::copy_n(row, span->before, stored);
            std::copy(row + span->before + span->full, row + count + span->full, stored + span->before);
        }
    solid.filled = 0;
    if (!solid.opposite.empty()) thicken(solid, cut);
    solid.units_y = units_along(solid.y0, solid.ny, n_[1], units_.rows);
    solid.units_z = units_along(solid.z0, solid.nz, n_[2], units_.planes);
}

/// What is stored of a sphere are the cells that it cuts.
void SolidMap::thicken(MappedSolid& solid, CutCells& cut) const
{
    const SolidGeometry& geometry = solid.solid.geometry;
    cut.clear({static_cast<int>(std::floor(geometry.centre[0] - geometry.radius)), solid.y0, solid.z0});
    for (int k = 0; k < solid.nz; ++k)
        for (int j = 0; j < solid.ny; ++j) {
            const Span* const span = &solid.spans[static_cast<std::size_t>(k) * solid.ny + j];
            const int x = span->x0 + span->before,
                      rest = static_cast<int>(span[1].fractions - span->fractions) - span->before;
            cut.add(span->x0, x, solid.y0 + j, solid.z0 + k);
            cut.add(x + span->full, x + span->full + rest, solid.y0 + j, solid.z0 + k);
        }
    solid.filled = cut.thicken(geometry.centre, geometry.radius, solid.opposite, solid.fractions.data() + kBlock);
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
    for (std::size_t s = 0; s < solids_.size(); ++s) {
        const MappedSolid& solid = solids_[s];
        const int end = solid.z0 + solid.nz;
        if (solid.z0 >= 0 && end <= n_[2] && (solid.z0 >= end_plane || end <= first_plane)) continue;
        Walk z(solid.z0, n_[2], units_.planes);
        for (int k = 0; k < solid.nz; ++k, z.next()) {
            if (z.cell < first_plane || z.cell >= end_plane) continue;
            Walk y(solid.y0, n_[1], units_.rows);
            const Span* const spans = solid.spans.data() + static_cast<std::size_t>(k) * solid.ny;
            for (int j = 0; j < solid.ny; ++j, y.next()) {
                const auto n = static_cast<std::int32_t>(spans[j + 1].fractions - spans[j].fractions) + spans[j].full;
                if (n == 0) continue;
                const int unit = z.unit % solid.units_z * solid.units_y + y.unit % solid.units_y;
                body(static_cast<std::size_t>(z.cell) * n_[1] + y.cell,
                     Piece{static_cast<std::int32_t>(s),
                           spans[j].fractions,
                           spans[j].x0,
                           n,
                           {0, static_cast<std::int8_t>(y.image), static_cast<std::int8_t>(z.image)},
                           static_cast<std::uint8_t>(unit),
                           spans[j].before,
                           spans[j].full});
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
    for_slabs([&](std::size_t row, const Piece& span) {
        int end = Walk(span.x0, n_[0], 1).cell + span.n;
        for (; end > 0; end -= n_[0]) ++row_begin_[row + 1];
    });
    for (std::size_t r = 1; r < row_begin_.size(); ++r) row_begin_[r] += row_begin_[r - 1];
    pieces_.resize(row_begin_.back());
    row_next_.assign(row_begin_.begin(), row_begin_.end() - 1);
    for_slabs([&](std::size_t row, Piece piece) {
        int rest = piece.n;
        Walk x(piece.x0, n_[0], 1);
        piece.x0 = x.cell;
        piece.image[0] = static_cast<std::int8_t>(x.image);
        while (rest > 0) {
            piece.n = std::min(rest, n_[0] - piece.x0);
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
