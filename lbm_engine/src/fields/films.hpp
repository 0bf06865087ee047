#pragma once

#include "fields/neighbours.hpp"
#include "physics/lubrication.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lbm {

/// A sphere as its films see it, in lattice units of length.
struct FilmSphere {
    Vec3 centre{};      ///< wrapped into the box in periodic directions
    double radius = 0;  ///< 0: not a sphere, and without films
    std::int64_t body =
        -1;           ///< members of one rigid body (>= 0) have no film between them, and share its mass and inertia
    FilmBody motion;  ///< velocity of the centre at the end of the step if there were no films; mass of the whole body
    Vec3 lever{};     ///< from the centre of mass of the rigid body to the centre
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
 * momentum of pairs. They act one after the other, part by part of the box; parts of one colour share no body, and may act at the same time. Parts and colours depend on
 * the spheres alone: the same bits with any number of threads. A step may be of any length; its units are those in which it is one.
 */
class Films {
public:
    /**
     * @param cells      of the box
     * @param periodic   for each axis
     * @param roughness  gap, in radii of the smaller sphere, below which a film gets no stronger
     */
    Films(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, double roughness);

    /**
     * Loads of one step; spheres in the same order. Neighbours are searched for only when something moved by a quarter of a cell, or when the spheres are others.
     * @param walls      for each face, null or its velocity
     * @param viscosity  in units of cell and step
     */
    const std::vector<FilmLoad>& solve(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls,
                                       double viscosity);

    std::size_t size() const noexcept;  ///< films in the last step
    const std::array<Vec3, 6>& forces_on_walls() const noexcept { return wall_forces_; }

private:
    /// Where a film is, or may soon be.
    struct Place {
        std::int32_t first, second;  // second >= 0: a sphere; otherwise -1 - face
        Vec3 shift;                  // of the second, to the image that is near
    };
    struct Part {
        std::vector<std::int32_t> spheres;
        std::vector<Place> near, places;  // of their films, and spheres that come after them
        std::vector<Film> films;
        double change2 = 0, all2 = 0;  // in the last sweep
        std::array<Vec3, 6> wall_forces{};
    };
    struct Colour {  // parts, from begin to end
        std::ptrdiff_t begin, end;
    };

    bool still_near(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls);
    void search(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls);
    void search_around(std::int32_t first, const std::vector<FilmSphere>& spheres,
                       const std::array<const Vec3*, 6>& walls, std::vector<Place>& near) const;
    void divide(double range);
    void colour(const std::vector<FilmSphere>& spheres);
    void make_films(const std::vector<FilmSphere>& spheres, double viscosity, Part& part) const;
    void gather_bodies(const std::vector<FilmSphere>& spheres, const std::array<const Vec3*, 6>& walls);
    void relax(Part& part, bool backwards);
    bool is_settled() const;
    void add_loads(Part& part);

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    double roughness_;
    Neighbours neighbours_;

    // of the last search
    struct Searched {
        Vec3 centre;
        double radius;
        std::int64_t body;
    };
    std::vector<Searched> searched_;
    std::array<bool, 6> searched_walls_{};
    std::vector<Part> parts_;  // colour by colour
    std::vector<Colour> colours_;

    std::vector<Vec3> centres_;          // not wrapped since the last search
    std::vector<FilmBody> bodies_;       // six walls, then the rigid bodies
    std::vector<std::int32_t> body_of_;  // for each sphere
    std::vector<FilmLoad> loads_;
    std::array<Vec3, 6> wall_forces_{};
};

}  // namespace lbm
