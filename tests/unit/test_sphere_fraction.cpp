#include "close.hpp"
#include "physics/sphere_fraction.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace {

using namespace lbm;

/// Stated in docs/physics.md: differences of volumes of order R^3 in double precision.
constexpr double kFractionError = 1e-12;

double total(const SphereFraction& s)
{
    double sum = 0;
    for (int k = 0; k < s.count()[2]; ++k)
        for (int j = 0; j < s.count()[1]; ++j)
            for (int i = 0; i < s.count()[0]; ++i) sum += s.row(j, k)[i];
    return sum;
}

double volume(double R) { return 4 * std::numbers::pi / 3 * R * R * R; }

/// Exact chords along z on n x n points, by the midpoint rule.
double by_chords(const Vec3& low, double R, int n)
{
    double sum = 0;
    for (int q = 0; q < n; ++q)
        for (int p = 0; p < n; ++p) {
            const double x = low[0] + (p + 0.5) / n, y = low[1] + (q + 0.5) / n, h2 = R * R - x * x - y * y;
            if (h2 <= 0) continue;
            const double h = std::sqrt(h2);
            sum += std::max(0.0, std::min(h, low[2] + 1) - std::max(-h, low[2]));
        }
    return sum / n / n;
}

class SolidFraction : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(SolidFraction);
    CPPUNIT_TEST(fractions_add_up_to_the_volume);
    CPPUNIT_TEST(cells_agree_with_fine_chords);
    CPPUNIT_TEST(inner_cells_are_full_and_outer_ones_empty);
    CPPUNIT_TEST(rows_end_where_their_fractions_do);
    CPPUNIT_TEST(half_cut_cells_are_half_full);
    CPPUNIT_TEST(sphere_inside_one_cell_is_whole);
    CPPUNIT_TEST_SUITE_END();

    std::mt19937 random{7};
    double uniform() { return std::uniform_real_distribution<>(0, 1)(random); }

    void fractions_add_up_to_the_volume()
    {
        SphereFraction s;
        for (const double R : {0.3, 1.0, 2.0, 4.344, 6.5, 21.0})
            for (int n = 0; n < 20; ++n) {
                s.evaluate({uniform() - 5, uniform(), 40 + uniform()}, R);
                LBM_ASSERT_CLOSE(volume(R), total(s), kFractionError, volume(R));
            }
    }

    void cells_agree_with_fine_chords()
    {
        constexpr int kPoints = 400;
        constexpr double kChordError = 5e-6;  // of the midpoint rule across the rim, n^(-3/2) and less
        SphereFraction s;
        for (const double R : {2.0, 4.344, 9.7}) {
            const Vec3 X{0.37, -0.11, 0.82};
            s.evaluate(X, R);
            for (int n = 0; n < 12; ++n) {
                const int i = std::min<int>(uniform() * s.count()[0], s.count()[0] - 1);
                const int j = std::min<int>(uniform() * s.count()[1], s.count()[1] - 1);
                const int k = std::min<int>(uniform() * s.count()[2], s.count()[2] - 1);
                const Vec3 low{s.first()[0] + i - X[0], s.first()[1] + j - X[1], s.first()[2] + k - X[2]};
                LBM_ASSERT_CLOSE(by_chords(low, R, kPoints), s.row(j, k)[i], kChordError, 1.0);
            }
        }
    }

    void inner_cells_are_full_and_outer_ones_empty()
    {
        SphereFraction s;
        const double R = 6.3;
        const Vec3 X{0.2, 0.5, 0.7};
        s.evaluate(X, R);
        for (int k = 0; k < s.count()[2]; ++k)
            for (int j = 0; j < s.count()[1]; ++j)
                for (int i = 0; i < s.count()[0]; ++i) {
                    double near2 = 0, far2 = 0;
                    const int cell[3] = {i, j, k};
                    for (int d = 0; d < 3; ++d) {
                        const double low = s.first()[d] + cell[d] - X[d], high = low + 1;
                        far2 += std::max(low * low, high * high);
                        near2 += low > 0 ? low * low : high < 0 ? high * high : 0;
                    }
                    const double epsilon = s.row(j, k)[i];
                    if (far2 < R * R) CPPUNIT_ASSERT_EQUAL(1.0, epsilon);
                    else if (near2 > R * R) CPPUNIT_ASSERT_EQUAL(0.0, epsilon);
                    else CPPUNIT_ASSERT(epsilon >= 0 && epsilon <= 1);
                }
    }

    void rows_end_where_their_fractions_do()
    {
        SphereFraction s;
        for (const double R : {0.3, 2.0, 6.1, 21.0})
            for (int n = 0; n < 20; ++n) {
                s.evaluate({uniform() - 5, uniform(), n < 2 ? 3.0 : uniform()}, R);
                for (int k = 0; k < s.count()[2]; ++k)
                    for (int j = 0; j < s.count()[1]; ++j) {
                        const RowEnds ends = s.ends()[k * s.count()[1] + j];
                        CPPUNIT_ASSERT(0 <= ends.begin && ends.begin <= ends.full_begin);
                        CPPUNIT_ASSERT(ends.full_begin <= ends.full_end && ends.full_end <= ends.end);
                        CPPUNIT_ASSERT(ends.end <= s.count()[0]);
                        for (int i = 0; i < s.count()[0]; ++i) {
                            const double epsilon = s.row(j, k)[i];
                            if (i < ends.begin || i >= ends.end) LBM_ASSERT_CLOSE(0, epsilon, kFractionError, 1.0);
                            else if (i >= ends.full_begin && i < ends.full_end)
                                LBM_ASSERT_CLOSE(1, epsilon, kFractionError, 1.0);
                        }
                    }
            }
    }

    void half_cut_cells_are_half_full()
    {
        // A large sphere is nearly a plane to a cell, up to the sagitta 1 / (12 R).
        SphereFraction s;
        const double R = 30;
        s.evaluate({0.5 - R, 0.5, 0.5}, R);
        const int i = -s.first()[0], j = -s.first()[1], k = -s.first()[2];
        LBM_ASSERT_CLOSE(0.5 - 1 / (12 * R), s.row(j, k)[i], 1e-5, 1.0);
    }

    void sphere_inside_one_cell_is_whole()
    {
        SphereFraction s;
        s.evaluate({0.5, 0.5, 0.5}, 0.25);
        CPPUNIT_ASSERT_EQUAL(1, s.count()[0]);
        LBM_ASSERT_CLOSE(volume(0.25), s.row(0, 0)[0], kFractionError, 1.0);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(SolidFraction);

}  // namespace
