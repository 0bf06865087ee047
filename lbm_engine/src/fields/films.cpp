#include "fields/films.hpp"

#include "fields/first_exception.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace lbm {
namespace {

/// Spheres in a part of the box, about: fewer, and the caches must be filled too often; more, and there is less to share.
constexpr double kSpheresOfPart = 128;

/// With fewer parts, or fewer of each colour, threads would wait for each other longer than they work.
constexpr std::size_t kWorthThreads = 16, kOfEachColour = 2;

/// One for each bit of a word; parts that find none act after the others, one by one.
constexpr int kColours = 64;

/// By so much wider gaps than films can have are kept in mind [cells]; two spheres may each use up half of it before the next search.
constexpr double kMargin = 0.5;

/// Sweeps over all films stop when they change the impulses by less than this fraction, or after so many: films take energy after any number.
constexpr double kSettled = 1e-4;
constexpr int kMostSweeps = 60;

/// Spheres that overlap by more than this part of a1 a2 / (a1 + a2) are no longer two surfaces with a film between them.
constexpr double kDeepestContact = 0.1;

double size2(const Film& film)
{
    return film.squeezed * film.squeezed + dot(film.sheared[0], film.sheared[0]) +
           dot(film.sheared[1], film.sheared[1]);
}

}  // namespace

Films::Films(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, double roughness)
    : n_(cells)
    , periodic_(periodic)
    , roughness_(roughness)
    , neighbours_(cells, periodic)
{
}

/// Whether the last search holds; brings the centres along.
bool Films::still_near(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls)
{
    for (int face = 0; face < 6; ++face)
        if (searched_walls_[face] != (walls[face] != nullptr)) return false;
    if (searched_.size() != spheres.size()) return false;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        const Searched& then = searched_[s];
        if (then.radius != spheres[s].radius || then.body != spheres[s].body) return false;
        Vec3 moved = spheres[s].centre - then.centre;
        for (int d = 0; d < 3; ++d)
            if (periodic_[d]) moved[d] -= n_[d] * std::round(moved[d] / n_[d]);
        if (!(dot(moved, moved) < 0.25 * kMargin * kMargin)) return false;
        centres_[s] = then.centre + moved;
    }
    return true;
}

void Films::search(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls)
{
    double largest = 0;
    searched_.clear();  // if no memory is left, this search does not hold
    centres_.clear();
    for (const FilmSphere& s : spheres) {
        largest = std::max(largest, s.radius);
        centres_.push_back(s.centre);
    }
    const double range = 2 * largest + kWidestFilm + kMargin;
    neighbours_.sort(centres_, range);
    divide(range);
    FirstException out_of_memory;
#pragma omp parallel for schedule(dynamic, 1) if (parts_.size() > 1)
    for (Part& part : parts_)
        out_of_memory.keep([&] {
            part.near.clear();
            for (const std::int32_t s : part.spheres) search_around(s, spheres, walls, part.near);
        });
    out_of_memory.rethrow();
    colour(spheres);
    for (int face = 0; face < 6; ++face) searched_walls_[face] = walls[face] != nullptr;
    for (const FilmSphere& s : spheres) searched_.push_back({s.centre, s.radius, s.body});
}

void Films::search_around(std::int32_t first, const std::vector<FilmSphere>& spheres,
                          const std::array<const Vec3*, 6>& walls, std::vector<Place>& near) const
{
    const FilmSphere& one = spheres[first];
    if (one.radius == 0) return;
    for (int face = 0; face < 6; ++face) {
        const int d = face / 2;
        const double distance = face % 2 == 0 ? one.centre[d] : n_[d] - one.centre[d];
        if (walls[face] && distance < one.radius + kWidestFilmAtWall + kMargin) near.push_back({first, -1 - face, {}});
    }
    neighbours_.for_near(first, [&](std::int32_t second, const Vec3& shift) {
        if (second <= first) return;
        const FilmSphere& two = spheres[second];
        if (two.radius == 0 || (one.body >= 0 && one.body == two.body)) return;
        const Vec3 apart = two.centre + shift - one.centre;
        const double reach = one.radius + two.radius + kWidestFilm + kMargin;
        if (dot(apart, apart) < reach * reach) near.push_back({first, second, shift});
    });
}

/// Spheres that are near each other come into one part.
void Films::divide(double range)
{
    const std::size_t count = centres_.size();
    const auto place = [&](std::size_t s, int d) {  // one that is lost would make all parts too large
        return std::clamp(centres_[s][d], 0.0, static_cast<double>(n_[d]));
    };
    Vec3 low{}, size{};
    for (int d = 0; d < 3; ++d) {
        double high = 0;
        low[d] = n_[d];
        for (std::size_t s = 0; s < count; ++s) {
            low[d] = std::min(low[d], place(s, d));
            high = std::max(high, place(s, d));
        }
        size[d] = std::max(range, high - low[d]);
    }
    const double wanted = std::max(1.0, static_cast<double>(count) / kSpheresOfPart);
    const double width = std::cbrt(size[0] * size[1] * size[2] / wanted);
    std::array<std::size_t, 3> parts{};
    for (int d = 0; d < 3; ++d) parts[d] = static_cast<std::size_t>(std::ceil(0.999 * size[d] / width));
    parts_.resize(parts[0] * parts[1] * parts[2]);
    for (Part& part : parts_) part.spheres.clear();
    for (std::size_t s = 0; s < count; ++s) {
        std::size_t part = 0;
        for (int d = 2; d >= 0; --d)
            part = part * parts[d] + std::min(static_cast<std::size_t>((place(s, d) - low[d]) / width), parts[d] - 1);
        parts_[part].spheres.push_back(static_cast<std::int32_t>(s));
    }
}

/// Each part gets the first colour that none of its bodies has yet. Walls may have all at once: they only move as they are told.
void Films::colour(const std::vector<FilmSphere>& spheres)
{
    std::unordered_map<std::int64_t, std::size_t> first_of_body;
    std::vector<std::size_t> body(spheres.size());
    for (std::size_t s = 0; s < spheres.size(); ++s)
        body[s] = spheres[s].body < 0 ? s : first_of_body.emplace(spheres[s].body, s).first->second;
    std::vector<std::uint64_t> used(spheres.size(), 0);
    constexpr int kLeftOver = kColours;  // parts for which no colour is left: one by one
    std::array<std::vector<Part>, kLeftOver + 1> of_colour;
    for (Part& part : parts_) {
        const auto for_bodies = [&](auto&& act) {
            for (const Place& place : part.near) {
                act(used[body[place.first]]);
                if (place.second >= 0) act(used[body[place.second]]);
            }
        };
        std::uint64_t taken = 0;
        for_bodies([&](std::uint64_t colours) { taken |= colours; });
        const int colour = std::countr_one(taken);
        if (colour != kLeftOver) for_bodies([&](std::uint64_t& colours) { colours |= std::uint64_t{1} << colour; });
        of_colour[colour].push_back(std::move(part));
    }
    parts_.clear();
    colours_.clear();
    for (std::vector<Part>& parts : of_colour) {
        const bool one_by_one = &parts == &of_colour.back();
        for (Part& part : parts) {
            const auto place = static_cast<std::ptrdiff_t>(parts_.size());
            if (one_by_one || &part == &parts.front()) colours_.push_back({place, place});
            colours_.back().end = place + 1;
            parts_.push_back(std::move(part));
        }
    }
}

void Films::make_films(const std::vector<FilmSphere>& spheres, double viscosity, Part& part) const
{
    part.places.clear();
    part.films.clear();
    for (const Place& place : part.near) {
        const FilmSphere& one = spheres[place.first];
        const double a1 = one.radius;
        const bool wall = place.second < 0;
        double a2 = std::numeric_limits<double>::infinity(), distance = 0, gap = 0;
        Vec3 normal{};
        if (wall) {
            const int face = -1 - place.second, d = face / 2;
            distance = face % 2 == 0 ? centres_[place.first][d] : n_[d] - centres_[place.first][d];
            gap = distance - a1;
            normal[d] = face % 2 == 0 ? -1 : 1;
        } else {
            a2 = spheres[place.second].radius;
            const Vec3 apart = centres_[place.second] + place.shift - centres_[place.first];
            distance = norm(apart);
            gap = distance - a1 - a2;
            normal = (1 / distance) * apart;
        }
        const double a = wall ? a1 : a1 * a2 / (a1 + a2);
        if (!(gap < (wall ? kWidestFilmAtWall : kWidestFilm) && gap >= -kDeepestContact * a)) continue;
        const double open = std::max(gap, roughness_ * std::min(a1, a2));
        const FilmResistance resistance = film_resistance(viscosity, a1, a2, open, seen_gaps(open, wall));
        Film film = make_film(normal, a1, a2, distance, resistance);
        film.lever[0] = one.lever;
        if (!wall) film.lever[1] = spheres[place.second].lever;
        part.places.push_back(place);
        part.films.push_back(film);
    }
}

/// Walls, single spheres, and rigid bodies of several: of those that respond, once; parts of prescribed ones each move as they are told.
void Films::gather_bodies(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls)
{
    bodies_.clear();
    for (const Vec3* wall : walls) bodies_.push_back({wall ? *wall : Vec3{}, {}, 0, 0});
    body_of_.resize(spheres.size());
    std::unordered_map<std::int64_t, std::int32_t> known;
    const auto gather = [&](std::int32_t s) {
        const FilmSphere& sphere = spheres[s];
        body_of_[s] = static_cast<std::int32_t>(bodies_.size());
        if (sphere.body >= 0 && sphere.motion.inverse_mass + sphere.motion.inverse_inertia > 0) {
            const auto [place, is_new] = known.emplace(sphere.body, body_of_[s]);
            body_of_[s] = place->second;
            if (!is_new) return;
        }
        bodies_.push_back(sphere.motion);
        bodies_.back().velocity -= cross(sphere.motion.angular_velocity, sphere.lever);
    };
    for (const Part& part : parts_)  // those of a part side by side, so that the caches hold them
        for (const std::int32_t s : part.spheres) gather(s);
}

std::size_t Films::size() const noexcept
{
    std::size_t films = 0;
    for (const Part& part : parts_) films += part.films.size();
    return films;
}

void Films::relax(Part& part, bool backwards)
{
    std::array<FilmBody, 6> walls;  // own ones: other parts may be at them, too
    std::copy_n(bodies_.begin(), walls.size(), walls.begin());
    double change2 = 0, all2 = 0;
    const std::size_t count = part.films.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t f = backwards ? count - 1 - i : i;
        const Place& place = part.places[f];
        Film& film = part.films[f];
        change2 += film.relax(bodies_[body_of_[place.first]],
                              place.second < 0 ? walls[-1 - place.second] : bodies_[body_of_[place.second]]);
        all2 += size2(film);
    }
    part.change2 = change2;
    part.all2 = all2;
}

bool Films::is_settled() const
{
    double change2 = 0, all2 = 0;
    for (const Part& part : parts_) {
        change2 += part.change2;
        all2 += part.all2;
    }
    return change2 <= kSettled * kSettled * all2;
}

void Films::add_loads(Part& part)
{
    part.wall_forces = {};
    for (std::size_t f = 0; f < part.films.size(); ++f) {
        const Film& film = part.films[f];
        const Place& place = part.places[f];
        const Vec3 force = film.force_on_second();
        const auto take = [&](FilmLoad& load, int which) {
            load.force += which == 0 ? -force : force;
            load.torque += film.torque_on(which);
            const Mat3 stresslet = film.stresslet_of(which);
            for (int d = 0; d < 3; ++d) load.stresslet[d] += stresslet[d];
        };
        take(loads_[place.first], 0);
        if (place.second >= 0) take(loads_[place.second], 1);
        else part.wall_forces[-1 - place.second] += force;
    }
}

const std::vector<FilmLoad>& Films::solve(const std::vector<FilmSphere>& spheres,
                                          const std::array<const Vec3*, 6>& walls, double viscosity)
{
    if (!still_near(spheres, walls)) search(spheres, walls);
    gather_bodies(spheres, walls);
    loads_.assign(spheres.size(), FilmLoad{});
    FirstException out_of_memory;
#pragma omp parallel for schedule(dynamic, 1) if (parts_.size() > kWorthThreads)
    for (Part& part : parts_) out_of_memory.keep([&] { make_films(spheres, viscosity, part); });
    out_of_memory.rethrow();
    const std::size_t colours = colours_.size();
    bool settled = false;
#pragma omp parallel if (parts_.size() > std::max(kWorthThreads, kOfEachColour * colours))
    {
        const auto colour_by_colour = [&](bool backwards, auto&& body) {
            for (std::size_t c = 0; c < colours; ++c) {
                const Colour colour = colours_[backwards ? colours - 1 - c : c];
#pragma omp for schedule(dynamic, 1)
                for (std::ptrdiff_t part = colour.begin; part < colour.end; ++part) body(parts_[part]);
            }
        };
        for (int sweep = 0; sweep < kMostSweeps && !settled; ++sweep) {
            const bool backwards = sweep % 2 == 1;  // both ways, so that chains settle sooner
            colour_by_colour(backwards, [&](Part& part) { relax(part, backwards); });
#pragma omp single
            settled = is_settled();
        }
        colour_by_colour(false, [&](Part& part) { add_loads(part); });
    }
    wall_forces_ = {};
    for (const Part& part : parts_)
        for (int face = 0; face < 6; ++face) wall_forces_[face] += part.wall_forces[face];
    return loads_;
}

}  // namespace lbm
