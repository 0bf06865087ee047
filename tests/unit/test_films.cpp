#include "close.hpp"
#include "fields/films.hpp"
#include "film_body.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <omp.h>

namespace {

using namespace lbm;
using lbm::test::moving;

constexpr double kWall = std::numeric_limits<double>::infinity();

double energy(const std::vector<FilmSphere>& spheres)
{
    double sum = 0;
    for (const FilmSphere& s : spheres)
        sum += 0.5 * dot(s.motion.velocity, s.motion.velocity) / s.motion.inverse_mass +
               0.5 * dot(s.motion.angular_velocity, s.motion.angular_velocity) / s.motion.inverse_inertia;
    return sum;
}

/// Which surfaces have films between them, and all films together.
class FilmsOfManySpheres : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(FilmsOfManySpheres);
    CPPUNIT_TEST(films_take_energy_at_any_step);
    CPPUNIT_TEST(films_stop_a_body_of_several_spheres_and_never_turn_it_round);
    CPPUNIT_TEST(every_pair_is_found_once_across_periodic_faces_too);
    CPPUNIT_TEST(pairs_are_found_while_spheres_move);
    CPPUNIT_TEST(threads_do_not_change_a_bit);
    CPPUNIT_TEST(parts_of_a_body_and_deep_overlaps_have_no_film);
    CPPUNIT_TEST_SUITE_END();

    static std::vector<FilmSphere> pack(int count, double box, unsigned seed, double mass = kWall)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> anywhere(0, box), speed(-0.1, 0.1), radius(2, 4);
        std::vector<FilmSphere> spheres(count);
        for (FilmSphere& s : spheres) {
            s.radius = radius(random);
            for (int d = 0; d < 3; ++d) s.centre[d] = anywhere(random);
            s.motion = moving({speed(random), speed(random), speed(random)},
                              {speed(random), speed(random), speed(random)}, mass, 5 * mass);
        }
        return spheres;
    }

    void films_take_energy_at_any_step()
    {
        const auto spheres = pack(60, 20, 3, 1.0);
        Films films({20, 20, 20}, {true, true, true}, 1e-4);
        for (const double viscosity : {0.1, 10.0, 1e5}) {
            const auto& loads = films.solve(spheres, {}, viscosity);
            CPPUNIT_ASSERT(films.size() > 20);
            auto after = spheres;
            Vec3 sum{};
            for (std::size_t s = 0; s < after.size(); ++s) {
                after[s].motion.velocity += loads[s].force;  // mass 1
                after[s].motion.angular_velocity += 0.2 * loads[s].torque;
                sum += loads[s].force;
            }
            CPPUNIT_ASSERT(energy(after) < energy(spheres));
            LBM_ASSERT_CLOSE(0, norm(sum), 1e-12, 10);
        }
    }

    /// Four members over a wall, as a clump: each of the films alone could stop all of its mass. Iterations end at changes of 1e-4, which leaves up to 3e-4 of the
    /// speed with the other sign; iterated to 1e-9 it is below 1e-6.
    void films_stop_a_body_of_several_spheres_and_never_turn_it_round()
    {
        constexpr double kMass = 40, kInertia = 700;
        const Vec3 wall{};
        for (const double viscosity : {1e-2, 1.0, 1e2, 1e5}) {
            std::vector<FilmSphere> members(4);
            const Vec3 velocity{0, -0.1, 0}, spin{0.01, 0, 0.02};
            for (int i = 0; i < 4; ++i) {
                members[i].lever = {i < 2 ? -4.0 : 4.0, 0, i % 2 ? -4.0 : 4.0};
                members[i].centre = Vec3{20, 3.1, 20} + members[i].lever;
                members[i].radius = 3;
                members[i].body = 9;
                members[i].motion = moving(velocity + cross(spin, members[i].lever), spin, kMass, kInertia);
            }
            Films films({40, 40, 40}, {false, false, false}, 1e-3);
            const auto& loads = films.solve(members, {nullptr, nullptr, &wall, nullptr, nullptr, nullptr}, viscosity);
            CPPUNIT_ASSERT_EQUAL(std::size_t{4}, films.size());
            Vec3 after = velocity, spin_after = spin;
            for (int i = 0; i < 4; ++i) {
                after += (1 / kMass) * loads[i].force;
                spin_after += (1 / kInertia) * (loads[i].torque + cross(members[i].lever, loads[i].force));
            }
            CPPUNIT_ASSERT(after[1] > velocity[1] && after[1] < 1e-3 * 0.1);
            CPPUNIT_ASSERT(kMass * dot(after, after) + kInertia * dot(spin_after, spin_after) <
                           kMass * dot(velocity, velocity) + kInertia * dot(spin, spin));
        }
    }

    void every_pair_is_found_once_across_periodic_faces_too()
    {
        for (const int box : {9, 14, 23, 40}) {
            const auto spheres = pack(25, box, 7);
            Films films({box, box, box}, {true, false, true}, 1e-4);
            const Vec3 wall{};
            films.solve(spheres, {nullptr, nullptr, &wall, nullptr, nullptr, nullptr}, 1);
            std::size_t expected = 0;
            for (std::size_t i = 0; i < spheres.size(); ++i) {
                const double above = spheres[i].centre[1] - spheres[i].radius;
                expected += above < kWidestFilmAtWall && above >= -0.1 * spheres[i].radius;
                for (std::size_t j = i + 1; j < spheres.size(); ++j)
                    for (int x = -3; x <= 3; ++x)
                        for (int z = -3; z <= 3; ++z) {
                            const Vec3 shift{double(x) * box, 0, double(z) * box};
                            const double a1 = spheres[i].radius, a2 = spheres[j].radius;
                            const double gap = norm(spheres[j].centre + shift - spheres[i].centre) - a1 - a2;
                            expected += gap < kWidestFilm && gap >= -0.1 * a1 * a2 / (a1 + a2);
                        }
            }
            CPPUNIT_ASSERT_EQUAL(expected, films.size());
        }
    }

    /// The list of neighbours is kept for some steps; it must not miss any, across periodic faces too.
    void pairs_are_found_while_spheres_move()
    {
        auto spheres = pack(40, 30, 9);
        Films kept({30, 30, 30}, {true, true, false}, 1e-3);
        for (int t = 0; t < 60; ++t) {
            for (FilmSphere& s : spheres)
                for (int d = 0; d < 3; ++d) {
                    s.centre[d] += s.motion.velocity[d];
                    if (d < 2) s.centre[d] -= 30 * std::floor(s.centre[d] / 30);
                }
            Films fresh({30, 30, 30}, {true, true, false}, 1e-3);
            const auto& expected = fresh.solve(spheres, {}, 0.2);
            const auto& loads = kept.solve(spheres, {}, 0.2);
            CPPUNIT_ASSERT_EQUAL(fresh.size(), kept.size());
            for (std::size_t s = 0; s < spheres.size(); ++s)
                LBM_ASSERT_CLOSE(0, norm(loads[s].force - expected[s].force), 1e-12, 1 + norm(expected[s].force));
        }
    }

    /// So many that parts of the box are solved at the same time, some with members of the same bodies in them.
    void threads_do_not_change_a_bit()
    {
        auto spheres = pack(6000, 110, 5, 20);
        for (int i = 0; i < 30; ++i) spheres[i].body = i / 3;
        const Vec3 wall{0.01, 0, 0};
        const int before = omp_get_max_threads();
        std::vector<FilmLoad> first;
        std::array<Vec3, 6> first_on_walls{};
        for (const int threads : {1, 2, 3, 7}) {
            omp_set_num_threads(threads);
            Films films({110, 110, 110}, {true, true, false}, 1e-3);
            const auto loads = films.solve(spheres, {nullptr, nullptr, nullptr, nullptr, &wall, &wall}, 0.2);
            if (first.empty()) {
                first = loads;
                first_on_walls = films.forces_on_walls();
            }
            CPPUNIT_ASSERT(films.forces_on_walls() == first_on_walls);
            for (std::size_t s = 0; s < loads.size(); ++s)
                CPPUNIT_ASSERT(loads[s].force == first[s].force && loads[s].torque == first[s].torque &&
                               loads[s].stresslet == first[s].stresslet);
        }
        omp_set_num_threads(before);
    }

    void parts_of_a_body_and_deep_overlaps_have_no_film()
    {
        Films films({60, 60, 60}, {false, false, false}, 1e-3);
        std::vector<FilmSphere> pair(2);
        pair[0] = {{20, 30, 30}, 5, -1, {}, {}};
        pair[1] = {{30.2, 30, 30}, 5, -1, {}, {}};
        films.solve(pair, {}, 1);
        CPPUNIT_ASSERT_EQUAL(std::size_t{1}, films.size());
        pair[0].body = pair[1].body = 3;
        films.solve(pair, {}, 1);
        CPPUNIT_ASSERT_EQUAL(std::size_t{0}, films.size());
        pair[1].body = 4;
        pair[1].centre[0] = 29.9;  // a contact
        films.solve(pair, {}, 1);
        CPPUNIT_ASSERT_EQUAL(std::size_t{1}, films.size());
        pair[1].centre[0] = 29;
        films.solve(pair, {}, 1);
        CPPUNIT_ASSERT_EQUAL(std::size_t{0}, films.size());
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(FilmsOfManySpheres);

}  // namespace
