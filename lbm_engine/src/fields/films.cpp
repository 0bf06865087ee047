#include "fields/films.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lbm {
namespace {

constexpr int kChunks = 64;  // of the search; fixed, so that the order of the films does not depend on threads

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
    , chunks_(kChunks)
{
}

void Films::sort_into_bins(const std::vector<FilmSphere>& spheres)
{
    double largest = 0;
    for (const FilmSphere& s : spheres) largest = std::max(largest, s.radius);
    const double range = 2 * largest + kWidestFilm;
    std::size_t count = 1;
    for (int d = 0; d < 3; ++d) {
        bins_[d] = std::max(1, static_cast<int>(n_[d] / range));
        reach_[d] = static_cast<int>(std::ceil(range * bins_[d] / n_[d]));
        count *= bins_[d];
    }
    bin_of_.resize(spheres.size());
    bin_begin_.assign(count + 1, 0);
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        std::int32_t bin = 0;
        for (int d = 2; d >= 0; --d) {
            const double place = std::floor(spheres[s].centre[d] * bins_[d] / n_[d]);
            bin = bin * bins_[d] + static_cast<std::int32_t>(std::clamp(place, 0.0, bins_[d] - 1.0));
        }
        bin_of_[s] = bin;
        ++bin_begin_[bin + 1];
    }
    for (std::size_t b = 0; b < count; ++b) bin_begin_[b + 1] += bin_begin_[b];
    in_bin_.resize(spheres.size());
    std::vector<std::int32_t> next(bin_begin_.begin(), bin_begin_.end() - 1);
    for (std::size_t s = 0; s < spheres.size(); ++s) in_bin_[next[bin_of_[s]]++] = static_cast<std::int32_t>(s);
}

void Films::add(Place place, const Vec3& normal, double a1, double a2, double distance, double gap, double viscosity,
                Found& found) const
{
    const double a = std::isinf(a2) ? a1 : a1 * a2 / (a1 + a2);
    if (gap >= kWidestFilm || gap < -kDeepestContact * a) return;
    const double smallest = roughness_ * std::min(a1, a2), open = std::max(gap, smallest);
    const FilmResistance resistance = film_resistance(viscosity, a1, a2, open, seen_gaps(open, std::isinf(a2)));
    found.places.push_back(place);
    found.films.push_back(make_film(normal, a1, a2, distance, resistance));
    found.closed.push_back(gap <= smallest);
}

void Films::find_of(std::int32_t first, const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls,
                    double viscosity, Found& found) const
{
    const FilmSphere& one = spheres[first];
    if (one.radius == 0) return;
    for (int face = 0; face < 6; ++face) {
        if (!walls[face]) continue;
        const int d = face / 2;
        const double distance = face % 2 == 0 ? one.centre[d] : n_[d] - one.centre[d];
        Vec3 normal{};
        normal[d] = face % 2 == 0 ? -1 : 1;
        add({first, -1 - face}, normal, one.radius, std::numeric_limits<double>::infinity(), distance,
            distance - one.radius, viscosity, found);
    }
    int bin[3], rest = bin_of_[first];
    for (int d = 0; d < 3; ++d) {
        bin[d] = rest % bins_[d];
        rest /= bins_[d];
    }
    int at[3];
    for (at[2] = bin[2] - reach_[2]; at[2] <= bin[2] + reach_[2]; ++at[2])
        for (at[1] = bin[1] - reach_[1]; at[1] <= bin[1] + reach_[1]; ++at[1])
            for (at[0] = bin[0] - reach_[0]; at[0] <= bin[0] + reach_[0]; ++at[0]) {
                Vec3 shift{};
                std::size_t other = 0;
                bool inside = true;
                for (int d = 2; d >= 0; --d) {
                    const int turns = static_cast<int>(std::floor(static_cast<double>(at[d]) / bins_[d]));
                    inside = inside && (turns == 0 || periodic_[d]);
                    shift[d] = static_cast<double>(turns) * n_[d];
                    other = other * bins_[d] + (at[d] - turns * bins_[d]);
                }
                if (!inside) continue;
                for (std::int32_t i = bin_begin_[other]; i < bin_begin_[other + 1]; ++i) {
                    const std::int32_t second = in_bin_[i];
                    if (second <= first) continue;
                    const FilmSphere& two = spheres[second];
                    if (two.radius == 0) continue;
                    const Vec3 apart = two.centre + shift - one.centre;
                    const double reach = one.radius + two.radius + kWidestFilm, distance2 = dot(apart, apart);
                    if (distance2 >= reach * reach || distance2 == 0 || (one.body >= 0 && one.body == two.body))
                        continue;
                    const double distance = std::sqrt(distance2);
                    add({first, second}, (1 / distance) * apart, one.radius, two.radius, distance,
                        distance - one.radius - two.radius, viscosity, found);
                }
            }
}

void Films::find(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls, double viscosity)
{
    sort_into_bins(spheres);
    const auto count = static_cast<std::int64_t>(spheres.size());
#pragma omp parallel for schedule(dynamic, 1) if (count > 64)
    for (int chunk = 0; chunk < kChunks; ++chunk) {
        Found& found = chunks_[chunk];
        found.places.clear();
        found.films.clear();
        found.closed.clear();
        for (std::int64_t s = count * chunk / kChunks; s < count * (chunk + 1) / kChunks; ++s)
            find_of(static_cast<std::int32_t>(s), spheres, walls, viscosity, found);
    }
    places_.clear();
    films_.clear();
    touches_.assign(spheres.size(), 0);
    for (const Found& found : chunks_) {
        places_.insert(places_.end(), found.places.begin(), found.places.end());
        films_.insert(films_.end(), found.films.begin(), found.films.end());
        for (std::size_t f = 0; f < found.films.size(); ++f) {
            if (!found.closed[f]) continue;
            touches_[found.places[f].first] = 1;
            if (found.places[f].second >= 0) touches_[found.places[f].second] = 1;
        }
    }
}

const std::vector<FilmLoad>& Films::solve(const std::vector<FilmSphere>& spheres,
                                          const std::array<const Vec3*, 6>& walls)
{
    motions_.resize(spheres.size() + 6);
    for (std::size_t s = 0; s < spheres.size(); ++s) motions_[s] = spheres[s].motion;
    FilmBody* const faces = motions_.data() + spheres.size();
    for (int face = 0; face < 6; ++face) faces[face] = {walls[face] ? *walls[face] : Vec3{}, {}, 0, 0};
    const auto second = [&](const Place& place) -> FilmBody& {
        return place.second >= 0 ? motions_[place.second] : faces[-1 - place.second];
    };
    const auto films = static_cast<std::ptrdiff_t>(films_.size());
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double change2 = 0, all2 = 0;
        for (std::ptrdiff_t i = 0; i < films; ++i) {
            const std::ptrdiff_t f = sweep % 2 == 0 ? i : films - 1 - i;  // both ways, so that chains settle sooner
            change2 += films_[f].relax(motions_[places_[f].first], second(places_[f]));
            all2 += size2(films_[f]);
        }
        if (change2 <= kSettled * kSettled * all2) break;
    }
    loads_.assign(spheres.size(), FilmLoad{});
    wall_forces_ = {};
    for (std::size_t f = 0; f < films_.size(); ++f) {
        const Film& film = films_[f];
        const Place place = places_[f];
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
