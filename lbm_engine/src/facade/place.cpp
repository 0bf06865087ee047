// The solids of a step: onto the lattice, with what is remembered of them.

#include "facade/implementation.hpp"
#include "facade/stopwatch.hpp"
#include "facade/validate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lbm {

/// Wrapped in periodic directions. Beyond the reach of the lattice nothing is mapped; the distance itself must stay countable.
Vec3 Fluid::Implementation::centre_in_box(const Solid& solid) const
{
    const double reach = 1e6 + (solid.radius + norm(solid.half_extents)) / units.length;
    Vec3 centre;
    for (int d = 0; d < 3; ++d) {
        double x = (solid.position[d] - config.lower[d]) / units.length;
        if (config.faces[2 * d].type == FaceType::periodic) x -= config.cells[d] * std::floor(x / config.cells[d]);
        centre[d] = std::clamp(x, -reach, config.cells[d] + reach);
    }
    return centre;
}

LatticeSolid Fluid::Implementation::in_lattice_units(const Solid& solid) const
{
    LatticeSolid lattice;
    SolidGeometry& geometry = lattice.geometry;
    geometry.shape = solid.shape;
    geometry.radius = solid.radius / units.length;
    geometry.half_extents = (1 / units.length) * solid.half_extents;
    geometry.axes = rotated_axes(solid.orientation);
    geometry.axis = solid.axis;
    lattice.body = solid.body;
    lattice.velocity = (1 / units.velocity) * solid.velocity;
    lattice.angular_velocity = units.time * solid.angular_velocity;
    geometry.centre = centre_in_box(solid);
    lattice.fixed = !std::isfinite(solid.mass) && !std::isfinite(solid.inertia) && solid.velocity == Vec3{} &&
                    solid.angular_velocity == Vec3{};
    return lattice;
}

/**
 * A free solid with the velocity that it will have within the step, as far as its last two tell. The load of a step acts on the solid after it, so the
 * drag would lag behind the motion; most of the lag is taken out so, less for light solids, whose stability would suffer.
 */
Solid Fluid::Implementation::in_mid_step(const Solid& solid, const Motion& last) const
{
    Solid mid = solid;
    if (std::isfinite(solid.mass)) mid.velocity += velocity_lead(last.share) * (solid.velocity - last.velocity);
    if (std::isfinite(solid.inertia))
        mid.angular_velocity += velocity_lead(last.spin_share) * (solid.angular_velocity - last.angular_velocity);
    return mid;
}

Vec3 Fluid::Implementation::way(const Solid& before, const Solid& now) const
{
    Vec3 moved = now.position - before.position;
    for (int d = 0; d < 3; ++d) {
        const double length = config.cells[d] * config.dx;
        if (config.faces[2 * d].type == FaceType::periodic) moved[d] -= length * std::round(moved[d] / length);
    }
    return moved;
}

bool Fluid::Implementation::is_same(const Solid& now, const Solid& before) const
{
    const Vec3 moved = way(before, now);
    const double distance2 = dot(moved, moved);
    const auto& h = now.half_extents;
    const double jump = now.shape == Shape::box ? std::min({h[0], h[1], h[2]}) : now.radius;
    return now.id == before.id && now.shape == before.shape && now.radius == before.radius &&
           now.half_extents == before.half_extents && now.axis == before.axis && distance2 <= jump * jump;
}

/**
 * A solid that comes in through an open face brings along the momentum of what fills its cells, and takes it away where it leaves: that is neither a load on it nor a force on the
 * face. Its part that is outside is taken to move with it.
 */
void Fluid::Implementation::carry_through_faces()
{
    if (!placed) forget_carried();
    placed = true;
    const bool any_open = std::any_of(config.faces.begin(), config.faces.end(), [](const FaceCondition& face) {
        return face.type == FaceType::velocity || face.type == FaceType::pressure;
    });
    if (!any_open) return;
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (volumes_before[s] >= 0 && volumes_before[s] != map.volume(s)) carry_through_faces(s);
}

void Fluid::Implementation::forget_carried()
{
    carried_in.assign(solids.size(), {});
    carried_by_face = {};
}

void Fluid::Implementation::carry_through_faces(std::size_t s)
{
    const LatticeSolid& solid = lattice_solids[s];
    const SolidGeometry& geometry = solid.geometry;
    // What comes in through each face in a step, about, and how it shares the volume that did.
    std::array<double, 6> rates{};
    std::array<Vec3, 6> sections{};  // their middles, from the centre
    double sum = 0, largest = 0;
    for (int face = 0; face < 6; ++face) {
        if (config.faces[face].type == FaceType::periodic) continue;
        const int d = face / 2;
        const double plane = face % 2 ? config.cells[d] : 0, at = plane - geometry.centre[d];
        const bool sphere = geometry.shape == Shape::sphere;
        const double reach = sphere ? geometry.radius : half_reach(geometry.axes, geometry.half_extents, d);
        if (std::abs(at) >= reach) continue;
        sections[face][d] = at;
        const double area = sphere ? std::numbers::pi * (reach * reach - at * at) : 1;
        const Vec3 u = solid.velocity + cross(solid.angular_velocity, sections[face]);
        rates[face] = (face % 2 ? -1 : 1) * u[d] * area;
        sum += rates[face];
        largest = std::max(largest, std::abs(rates[face]));
    }
    if (largest == 0) return;
    const double volume = map.volume(s) - volumes_before[s];
    const double scale = std::abs(sum) > 0.1 * largest ? volume / sum : 1;
    for (int face = 0; face < 6; ++face) {
        const FaceType type = config.faces[face].type;
        if (rates[face] == 0 || (type != FaceType::velocity && type != FaceType::pressure)) continue;
        const Vec3 u = solid.velocity + cross(solid.angular_velocity, sections[face]);
        const Vec3 momentum = (scale * rates[face]) * u;
        carried_in[s].momentum += momentum;
        carried_in[s].moment += cross(sections[face], momentum);
        carried_by_face[face].momentum += momentum;
        carried_by_face[face].moment += cross(geometry.centre + sections[face], momentum);
    }
}

void Fluid::Implementation::place(const std::vector<Solid>& now)
{
    const ThreadCount threads(config);
    Stopwatch watch;
    const auto count = static_cast<std::ptrdiff_t>(now.size());
    bool same_ids = now.size() == solids.size();
    for (std::ptrdiff_t s = 0; same_ids && s < count; ++s) same_ids = is_same(now[s], solids[s]);
    validate(config, now);
    if (!same_ids) require_unique_ids(now);

    previous.resize(now.size());
    bool any_new = false;
    for (std::ptrdiff_t s = 0; s < count; ++s) {
        if (same_ids) {
            previous[s] = static_cast<int>(s);
            continue;
        }
        const auto found = index_of_id.find(now[s].id);
        const bool known = found != index_of_id.end() && is_same(now[s], solids[found->second]);
        previous[s] = known ? found->second : -1;
        any_new = any_new || !known;
    }
    lattice_solids.resize(now.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t s = 0; s < count; ++s)
        lattice_solids[s] = in_lattice_units(previous[s] < 0 ? now[s] : in_mid_step(now[s], last_motions[previous[s]]));
    volumes_before.resize(now.size());
    if (placed && !same_ids) {
        std::vector<Carried> kept(now.size());
        for (std::ptrdiff_t s = 0; s < count; ++s)
            if (previous[s] >= 0) kept[s] = carried_in[previous[s]];
        carried_in = std::move(kept);
    }
    for (std::ptrdiff_t s = 0; s < count; ++s) volumes_before[s] = previous[s] < 0 ? -1 : map.volume(previous[s]);
    map.update(lattice_solids, previous);
    for (std::ptrdiff_t s = 0; s < count; ++s)
        if (previous[s] >= 0) ledgers[previous[s]].move((1 / units.length) * way(solids[previous[s]], now[s]));
    if (!same_ids) {
        std::vector<LoadLedger> kept(now.size());
        std::vector<Motion> motions(now.size());
        if (any_new && steps == 0 && config.initial_velocity == Vec3{})
            sum_inside(momentum_at_rest(), collision, map, config.cells[0]);
        else if (any_new)
            std::visit([&](const auto& f) { sum_inside(f, collision, config.inertia, map, &CellState::momentum); },
                       populations);
        index_of_id.clear();
        for (std::ptrdiff_t s = 0; s < count; ++s) {
            index_of_id.emplace(now[s].id, static_cast<int>(s));
            if (previous[s] >= 0) {
                kept[s] = ledgers[previous[s]];
                motions[s] = last_motions[previous[s]];
            } else {
                motions[s] = {now[s].velocity, now[s].angular_velocity, 0, 0};
                const SolidSums sums = map.sums(s);
                kept[s].momentum = sums.momentum;
                kept[s].angular_momentum = sums.angular_momentum;
            }
        }
        ledgers = std::move(kept);
        last_motions = std::move(motions);
        loads.assign(now.size(), SolidLoad{});
    }
    solids = now;
    carry_through_faces();
    times.map += watch.lap();
}

}  // namespace lbm
