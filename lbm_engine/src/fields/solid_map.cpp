#include "fields/solid_map.hpp"

#include "fields/first_exception.hpp"
#include "fields/prefetch.hpp"
#include "fields/wall_cells.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace lbm {

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
    prefetch_memory(solid.spans);
    prefetch_memory(solid.fractions);
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

void SolidMap::scale_velocities(double s)
{
    for (MappedSolid& solid : solids_) {
        solid.solid.velocity = s * solid.solid.velocity;
        solid.solid.angular_velocity = s * solid.solid.angular_velocity;
    }
    tell_rows();
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
