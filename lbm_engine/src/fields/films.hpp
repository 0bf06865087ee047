#pragma once

#include "physics/lubrication.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lbm {

/// A sphere as its films see it, in lattice units.
struct FilmSphere {
    Vec3 centre{};           ///< wrapped into the box in periodic directions
    double radius = 0;       ///< 0: not a sphere, and without films
    std::int64_t body = -1;  ///< members of one rigid body (>= 0) have no film between them
    FilmBody motion;         ///< that it would have without films at the end of the step
};

/// What films do to one sphere in a step, in lattice units.
struct FilmLoad {
    Vec3 force{}, torque{};
    Mat3 stresslet{};
};

/**
 * The thin films between spheres, and between spheres and no-slip faces: found by cell lists, and solved all at once.
 *
 * The films' impulses obey `impulse = - resistance (velocities at the end of the step)`, so that they take energy at any step, and keep momentum and angular
 * momentum of pairs. Order is fixed: the same bits with any number of threads.
 */
class Films {
public:
    /**
     * @param cells      of the box
     * @param periodic   for each axis
     * @param roughness  gap, in radii of the smaller sphere, below which a film gets no stronger
     */
    Films(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, double roughness);

    /// Which films there are. Motions are not asked for: who touches whom may be needed to know them.
    /// @param walls      for each face, null or its velocity
    /// @param viscosity  in lattice units
    void find(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls, double viscosity);

    /// Whether one of the sphere's gaps is closed down to the roughness.
    bool touches(std::size_t sphere) const noexcept { return touches_[sphere] != 0; }

    /// Loads of one step of the films that were found; spheres in the same order.
    const std::vector<FilmLoad>& solve(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls);

    std::size_t size() const noexcept { return films_.size(); }  ///< films in the last step
    const std::array<Vec3, 6>& forces_on_walls() const noexcept { return wall_forces_; }

private:
    struct Place {
        std::int32_t first, second;  // second >= 0: a sphere; otherwise -1 - face
    };
    struct Found {
        std::vector<Place> places;
        std::vector<Film> films;
        std::vector<char> closed;
    };

    void sort_into_bins(const std::vector<FilmSphere>& spheres);
    void find_of(std::int32_t first, const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls,
                 double viscosity, Found& found) const;
    void add(Place place, const Vec3& normal, double a1, double a2, double distance, double gap, double viscosity,
             Found& found) const;

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    double roughness_;

    // bins: counting sort
    std::array<int, 3> bins_{}, reach_{};
    std::vector<std::int32_t> bin_begin_, in_bin_, bin_of_;

    std::vector<Found> chunks_;
    std::vector<Place> places_;
    std::vector<Film> films_;
    std::vector<char> touches_;
    std::vector<FilmBody> motions_;
    std::vector<FilmLoad> loads_;
    std::array<Vec3, 6> wall_forces_{};
};

}  // namespace lbm
