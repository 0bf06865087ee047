#include "fields/films.hpp"

#include "fields/first_exception.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace lbm {
namespace {

constexpr int kParts = 64;  // of the search; fixed, so that the order of the films does not depend on threads

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
    , parts_(kParts)
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
    centres_.clear();
    for (const FilmSphere& s : spheres) {
        largest = std::max(largest, s.radius);
        centres_.push_back(s.centre);
    }
    neighbours_.sort(centres_, 2 * largest + kWidestFilm + kMargin);
    const auto count = static_cast<std::int64_t>(spheres.size());
    FirstException out_of_memory;
#pragma omp parallel for schedule(dynamic, 1) if (count > 64)
    for (int part = 0; part < kParts; ++part)
        out_of_memory.keep([&] {
            parts_[part].near.clear();
            for (std::int64_t s = count * part / kParts; s < count * (part + 1) / kParts; ++s)
                search_around(static_cast<std::int32_t>(s), spheres, walls, parts_[part].near);
        });
    out_of_memory.rethrow();
    for (int face = 0; face < 6; ++face) searched_walls_[face] = walls[face] != nullptr;
    searched_.clear();
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
        if (walls[face] && distance < one.radius + kWidestFilm + kMargin) near.push_back({first, -1 - face, {}});
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

void Films::make_films(const std::vector<FilmSphere>& spheres, double viscosity, Part& part) const
{
    part.places.clear();
    part.films.clear();
    for (const Place& place : part.near) {
        const FilmSphere& one = spheres[place.first];
        const double a1 = one.radius;
        double a2 = std::numeric_limits<double>::infinity(), distance = 0, gap = 0;
        Vec3 normal{};
        if (place.second < 0) {
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
        const double a = place.second < 0 ? a1 : a1 * a2 / (a1 + a2);
        if (!(gap < kWidestFilm && gap >= -kDeepestContact * a)) continue;
        const double open = std::max(gap, roughness_ * std::min(a1, a2));
        const FilmResistance resistance = film_resistance(viscosity, a1, a2, open, seen_gaps(open, std::isinf(a2)));
        Film film = make_film(normal, a1, a2, distance, resistance);
        film.lever[0] = one.lever;
        if (place.second >= 0) film.lever[1] = spheres[place.second].lever;
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
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        const FilmSphere& sphere = spheres[s];
        const auto next = static_cast<std::int32_t>(bodies_.size());
        body_of_[s] = next;
        if (sphere.body >= 0 && sphere.motion.inverse_mass + sphere.motion.inverse_inertia > 0) {
            const auto [place, is_new] = known.emplace(sphere.body, next);
            body_of_[s] = place->second;
            if (!is_new) continue;
        }
        bodies_.push_back(sphere.motion);
        bodies_.back().velocity -= cross(sphere.motion.angular_velocity, sphere.lever);
    }
}

const std::vector<FilmLoad>& Films::solve(const std::vector<FilmSphere>& spheres,
                                          const std::array<const Vec3*, 6>& walls, double viscosity)
{
    if (!still_near(spheres, walls)) search(spheres, walls);
    gather_bodies(spheres, walls);
    FirstException out_of_memory;
#pragma omp parallel for schedule(dynamic, 1) if (spheres.size() > 64)
    for (int part = 0; part < kParts; ++part) out_of_memory.keep([&] { make_films(spheres, viscosity, parts_[part]); });
    out_of_memory.rethrow();
    places_.clear();
    films_.clear();
    for (const Part& part : parts_) {
        places_.insert(places_.end(), part.places.begin(), part.places.end());
        films_.insert(films_.end(), part.films.begin(), part.films.end());
    }

    const auto second = [&](const Place& place) -> FilmBody& {
        return bodies_[place.second >= 0 ? body_of_[place.second] : -1 - place.second];
    };
    const auto films = static_cast<std::ptrdiff_t>(films_.size());
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double change2 = 0, all2 = 0;
        for (std::ptrdiff_t i = 0; i < films; ++i) {
            const std::ptrdiff_t f = sweep % 2 == 0 ? i : films - 1 - i;  // both ways, so that chains settle sooner
            change2 += films_[f].relax(bodies_[body_of_[places_[f].first]], second(places_[f]));
            all2 += size2(films_[f]);
        }
        if (change2 <= kSettled * kSettled * all2) break;
    }
    loads_.assign(spheres.size(), FilmLoad{});
    wall_forces_ = {};
    for (std::size_t f = 0; f < films_.size(); ++f) {
        const Film& film = films_[f];
        const Place& place = places_[f];
        const Vec3 force = film.force_on_second();
        const auto take = [&](FilmLoad& load, int which) {
            load.force += which == 0 ? -force : force;
            load.torque += film.torque_on(which);
            const Mat3 stresslet = film.stresslet_of(which);
            for (int d = 0; d < 3; ++d) load.stresslet[d] += stresslet[d];
        };
        take(loads_[place.first], 0);
        if (place.second >= 0) take(loads_[place.second], 1);
        else wall_forces_[-1 - place.second] += force;
    }
    return loads_;
}

}  // namespace lbm
