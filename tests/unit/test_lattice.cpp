#include "close.hpp"
#include "lattice/d3q19.hpp"
#include "lattice/d3q27.hpp"
#include "lattice/units.hpp"

#include <cppunit/extensions/HelperMacros.h>

namespace {

using lbm::D3Q19;
using lbm::D3Q27;

constexpr double kRoundOff = 1e-15;

class Lattice : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Lattice);
    CPPUNIT_TEST(opposite_directions_are_opposite);
    CPPUNIT_TEST(weights_are_isotropic_to_fourth_order);
    CPPUNIT_TEST(units_of_mechanics_fit_together);
    CPPUNIT_TEST(time_step_and_relaxation_time_are_inverse);
    CPPUNIT_TEST_SUITE_END();

    void opposite_directions_are_opposite()
    {
        opposite_directions<D3Q19>();
        opposite_directions<D3Q27>();
    }
    void weights_are_isotropic_to_fourth_order()
    {
        weights<D3Q19>();
        weights<D3Q27>();
    }

    template <class L>
    void opposite_directions()
    {
        for (int i = 0; i < L::Q; ++i) {
            CPPUNIT_ASSERT_EQUAL(i, L::opposite(L::opposite(i)));
            for (int d = 0; d < 3; ++d) CPPUNIT_ASSERT_EQUAL(-L::c[i][d], L::c[L::opposite(i)][d]);
        }
    }

    template <class L>
    void weights()
    {
        const auto delta = [](int a, int b) { return a == b ? 1.0 : 0.0; };
        double zeroth = 0;
        for (int i = 0; i < L::Q; ++i) zeroth += L::w(i);
        LBM_ASSERT_CLOSE(1.0, zeroth, kRoundOff, 1.0);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                double second = 0;
                for (int i = 0; i < L::Q; ++i) second += L::w(i) * L::c[i][a] * L::c[i][b];
                LBM_ASSERT_CLOSE(delta(a, b) / 3, second, kRoundOff, 1.0);
                for (int c = 0; c < 3; ++c)
                    for (int d = 0; d < 3; ++d) {
                        double fourth = 0;
                        for (int i = 0; i < L::Q; ++i)
                            fourth += L::w(i) * L::c[i][a] * L::c[i][b] * L::c[i][c] * L::c[i][d];
                        const double isotropic =
                            delta(a, b) * delta(c, d) + delta(a, c) * delta(b, d) + delta(a, d) * delta(b, c);
                        LBM_ASSERT_CLOSE(isotropic / 9, fourth, kRoundOff, 1.0);
                    }
            }
    }

    void units_of_mechanics_fit_together()
    {
        const lbm::Units u(1e-3, 2e-5, 970);
        LBM_ASSERT_CLOSE(970e-9, u.mass, kRoundOff, u.mass);
        LBM_ASSERT_CLOSE(50.0, u.velocity, kRoundOff, u.velocity);
        LBM_ASSERT_CLOSE(u.mass * u.velocity / u.time, u.force, kRoundOff, u.force);
        LBM_ASSERT_CLOSE(u.force * u.length, u.torque, kRoundOff, u.torque);
        LBM_ASSERT_CLOSE(u.force / (u.length * u.length), u.pressure, kRoundOff, u.pressure);
        LBM_ASSERT_CLOSE(u.density * u.velocity * u.velocity, u.pressure, kRoundOff, u.pressure);
        LBM_ASSERT_CLOSE(u.inertia / (u.time * u.time), u.torque, kRoundOff, u.torque);
    }

    void time_step_and_relaxation_time_are_inverse()
    {
        const double dx = 1e-3, nu = 3.8e-4;
        const double dt = lbm::fluid_time_step(0.8, dx, nu);
        LBM_ASSERT_CLOSE(0.8, lbm::relaxation_time(dt, dx, nu), kRoundOff, 1.0);
        LBM_ASSERT_CLOSE((0.8 - 0.5) / 3, nu * dt / (dx * dx), kRoundOff, 1.0);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Lattice);

}  // namespace
