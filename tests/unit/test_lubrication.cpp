#include "close.hpp"
#include "film_body.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace {

using namespace lbm;
using lbm::test::moving;

constexpr double kRoundOff = 1e-13;
constexpr double kWall = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

/// The whole film, as if the lattice saw an infinitely wide gap up to a constant: for differences between two gaps.
FilmResistance between_gaps(double a1, double a2, double narrow, double wide)
{
    return film_resistance(1, a1, a2, narrow, {wide, wide, wide});
}

/// The film of one gap.
class Lubrication : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Lubrication);
    CPPUNIT_TEST(squeezed_films_follow_the_exact_series);
    CPPUNIT_TEST(sheared_films_at_a_wall_follow_the_exact_series);
    CPPUNIT_TEST(unequal_spheres_agree_with_jeffrey_and_onishi);
    CPPUNIT_TEST(wide_gaps_have_no_film_and_narrow_ones_begin_smoothly);
    CPPUNIT_TEST(a_pair_that_moves_as_one_body_feels_nothing);
    CPPUNIT_TEST(pairs_keep_momentum_and_angular_momentum);
    CPPUNIT_TEST(prescribed_motion_feels_resistance_times_velocity);
    CPPUNIT_TEST_SUITE_END();

    // Differences between neighbouring lines of tests/reference/06_lubrication_normal.csv; asymptotes miss h ln h.
    void squeezed_films_follow_the_exact_series()
    {
        const double stokes = 6 * kPi;
        LBM_ASSERT_CLOSE(1002.35332688 - 101.896172325, between_gaps(1, kWall, 0.001, 0.01).squeeze / stokes, 1e-5,
                         900);
        LBM_ASSERT_CLOSE(101.896172325 - 21.585820437, between_gaps(1, kWall, 0.01, 0.05).squeeze / stokes, 3e-4, 80);
        // Each of two equal spheres moves at U: the gap closes at 2 U.
        LBM_ASSERT_CLOSE(504.454632087 - 53.4222936539, 2 * between_gaps(1, 1, 0.001, 0.01).squeeze / stokes, 1e-4,
                         450);
        LBM_ASSERT_CLOSE(53.4222936539 - 12.7112881698, 2 * between_gaps(1, 1, 0.01, 0.05).squeeze / stokes, 1e-3, 40);
    }

    // tests/reference/06_lubrication_tangential.csv, gaps 0.003 and 0.01; the next terms, h ln h, are 1 to 5 % of the differences.
    void sheared_films_at_a_wall_follow_the_exact_series()
    {
        constexpr double kNextTerms = 0.06;
        const FilmResistance r = between_gaps(1, kWall, 0.003, 0.01);
        Film film = make_film({0, 0, -1}, 1, kWall, 1.003, r);
        FilmBody sliding = moving({1, 0, 0}, {}), wall;
        film.relax(sliding, wall);
        LBM_ASSERT_CLOSE(4.05676530 - 3.42253296, film.force_on_second()[0] / (6 * kPi), kNextTerms, 0.63);
        LBM_ASSERT_CLOSE(0.39126359 - 0.27651740, film.torque_on(0)[1] / (8 * kPi), kNextTerms, 0.115);

        film = make_film({0, 0, -1}, 1, kWall, 1.003, r);
        FilmBody turning = moving({}, {0, 1, 0});
        film.relax(turning, wall);
        LBM_ASSERT_CLOSE(0.52168484 - 0.36868988, -film.force_on_second()[0] / (6 * kPi), kNextTerms, 0.15);
        LBM_ASSERT_CLOSE(2.70478468 - 2.24079761, -film.torque_on(0)[1] / (8 * kPi), kNextTerms, 0.46);
    }

    /// Leading terms of Jeffrey & Onishi (1984): X^A g1, g2; Y^A g2, Y^B g2, Y^C g2, in ln(1/xi).
    void unequal_spheres_agree_with_jeffrey_and_onishi()
    {
        for (const double L : {0.5, 1.0, 3.0}) {
            const double narrow = 1e-7, wide = 1e-5, log_ratio = std::log(wide / narrow);
            const double cube = (1 + L) * (1 + L) * (1 + L);
            const FilmResistance r = between_gaps(1, L, narrow, wide);
            const double g1 = 2 * L * L / cube, g2 = L * (1 + 7 * L + L * L) / (5 * cube);
            const double squeeze = g1 * (1 + L) / 2 * (1 / narrow - 1 / wide) + g2 * log_ratio;
            LBM_ASSERT_CLOSE(squeeze, r.squeeze / (6 * kPi), 1e-12, squeeze);

            const Vec3 n{0, 0, 1};
            Film film = make_film(n, 1, L, 1 + L + narrow, r);
            FilmBody first = moving({1, 0, 0}, {}), second = moving({}, {});
            film.relax(first, second);
            const double slide = 4 * L * (2 + L + 2 * L * L) / (15 * cube) * log_ratio;
            LBM_ASSERT_CLOSE(slide, film.force_on_second()[0] / (6 * kPi), 1e-6, slide);
            // T1 = 4 pi a^2 Y^B F-U coupling, |Y^B_11| = L (4 + L) / (5 (1 + L)^2) ln(1/xi)
            const double turn = L * (4 + L) / (5 * (1 + L) * (1 + L)) * log_ratio;
            LBM_ASSERT_CLOSE(turn, std::abs(film.torque_on(0)[1]) / (4 * kPi), 1e-6, turn);

            film = make_film(n, 1, L, 1 + L + narrow, r);
            FilmBody spinning = moving({}, {0, 1, 0});
            film.relax(spinning, second);
            const double own = 2 * L / (5 * (1 + L)) * log_ratio;
            LBM_ASSERT_CLOSE(own, -film.torque_on(0)[1] / (8 * kPi), 1e-6, own);
            const double other = 4 * L * L / (5 * (1 + L) * cube) * log_ratio * cube / 8;
            LBM_ASSERT_CLOSE(other, -film.torque_on(1)[1] / (8 * kPi), 1e-6, other);
        }
    }

    void wide_gaps_have_no_film_and_narrow_ones_begin_smoothly()
    {
        for (const bool wall : {false, true}) {
            const double a2 = wall ? kWall : 5;
            const auto squeeze = [&](double gap) {
                return film_resistance(1, 5, a2, gap, seen_gaps(gap, wall)).squeeze;
            };
            const double end = wall ? kWidestFilmAtWall : kWidestSqueeze;
            CPPUNIT_ASSERT_EQUAL(0.0, squeeze(end));
            CPPUNIT_ASSERT_EQUAL(0.0, squeeze(kWidestFilmAtWall));
            CPPUNIT_ASSERT_EQUAL(0.0, film_resistance(1, 5, a2, 2, seen_gaps(2, wall)).slide);
            // At the cut-off and a tenth of a cell inside: nothing to see beside Stokes drag.
            LBM_ASSERT_CLOSE(0, squeeze(end - 0.1), wall ? 1e-4 : 0.02, 6 * kPi * 5);
            for (double gap = 0.01; gap < end - 0.02; gap += 0.01) CPPUNIT_ASSERT(squeeze(gap) > squeeze(gap + 0.01));
        }
    }

    static Film any_film(double strength = 1)
    {
        const Vec3 n{2.0 / 3, -1.0 / 3, 2.0 / 3};
        return make_film(n, 4, 6.5, 10.7, {30 * strength, 8 * strength, 5 * strength});
    }

    void a_pair_that_moves_as_one_body_feels_nothing()
    {
        Film film = any_film();
        const Vec3 spin{0.1, -0.3, 0.2}, drift{0.5, 0.2, -0.1};
        FilmBody first = moving(drift, spin), second = moving(drift + cross(spin, 10.7 * film.normal), spin);
        film.relax(first, second);
        LBM_ASSERT_CLOSE(0, norm(film.force_on_second()), kRoundOff, 100);
        LBM_ASSERT_CLOSE(0, norm(film.torque_on(0)) + norm(film.torque_on(1)), kRoundOff, 100);
    }

    /// Of spheres, and of bodies whose centres are somewhere else.
    void pairs_keep_momentum_and_angular_momentum()
    {
        for (const double off : {0.0, 1.0}) {
            Film film = any_film();
            film.lever[0] = off * Vec3{3, -5, 1};
            film.lever[1] = off * Vec3{-2, 1, 6};
            const Vec3 centres[2] = {-film.lever[0], 10.7 * film.normal - film.lever[1]};
            const FilmBody before[2] = {moving({0.1, 0.3, -0.2}, {0.02, -0.01, 0.05}, 300, 2000),
                                        moving({-0.2, 0.1, 0.4}, {-0.03, 0.02, 0.01}, 1200, 20000)};
            FilmBody after[2] = {before[0], before[1]};
            film.relax(after[0], after[1]);
            Vec3 momentum{}, angular{};
            for (int i = 0; i < 2; ++i) {
                const double mass = 1 / before[i].inverse_mass, inertia = 1 / before[i].inverse_inertia;
                const Vec3 gained = mass * (after[i].velocity - before[i].velocity);
                momentum += gained;
                angular += inertia * (after[i].angular_velocity - before[i].angular_velocity);
                angular += cross(centres[i], gained);
            }
            LBM_ASSERT_CLOSE(0, norm(momentum), kRoundOff, 300);
            LBM_ASSERT_CLOSE(0, norm(angular), kRoundOff, 3000);
            CPPUNIT_ASSERT(norm(film.torque_on(0)) > 0.1);
        }
    }

    void prescribed_motion_feels_resistance_times_velocity()
    {
        Film film = any_film();
        const Vec3 n = film.normal;
        FilmBody first = moving(0.3 * n, {}), second;
        film.relax(first, second);
        for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(9.0 * n[d], film.force_on_second()[d], kRoundOff, 9);
        LBM_ASSERT_CLOSE(0, film.relax(first, second), kRoundOff, 81);
        // Two thirds of n n F times the arm, for an approach.
        const Mat3 s = film.stresslet_of(0);
        const double arm = 10.7 * 4 / 10.5;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                LBM_ASSERT_CLOSE(-9 * arm * (n[a] * n[b] - (a == b) / 3.0), s[a][b], kRoundOff, 9 * arm);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Lubrication);

}  // namespace
