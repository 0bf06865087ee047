#include "close.hpp"
#include "lattice_units.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <numbers>

namespace {

using namespace lbm;

/// What the scheme solves exactly, after the transient has decayed.
constexpr double kExact = 1e-8;
constexpr double kRoundOff = 1e-13;
/// Sixteen cells, tau = 1.1; before there are walls to be felt it is round-off.
constexpr double kStartUp = 3e-3;

/// Flows between plane walls, for which half-way bounce-back is exact.
class Channel : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Channel);
    CPPUNIT_TEST(poiseuille_is_exact_at_the_magic_parameter_of_the_wall);
    CPPUNIT_TEST(couette_is_exact_on_every_axis);
    CPPUNIT_TEST(a_drive_starts_a_channel_from_rest);
    CPPUNIT_TEST(a_drive_against_walls_moves_nothing);
    CPPUNIT_TEST(mass_is_kept_in_closed_and_periodic_boxes);
    CPPUNIT_TEST(a_box_whose_walls_move_together_carries_its_fluid);
    CPPUNIT_TEST_SUITE_END();

    void poiseuille_is_exact_at_the_magic_parameter_of_the_wall()
    {
        // Lambda = 3/16 puts the wall exactly half-way for a parabola (Ginzburg & d'Humieres 2003, Phys. Rev. E 68, 066614).
        for (const double tau : {0.6, 2.0}) {
            const int n = 9;
            FluidConfig c = test::lattice_config({3, 2, n}, tau);
            c.magic_parameter = 0.1875;
            c.acceleration = {1e-5, 0, 0};
            test::walls(c, 2);
            Fluid fluid(c);
            for (int t = 0; t < 8000; ++t) fluid.step();
            const double u_max = 1e-5 * n * n / (8 * c.viscosity);
            const auto u = fluid.velocity_field();
            for (int z = 0; z < n; ++z) {
                const double s = (z + 0.5) / n;
                LBM_ASSERT_CLOSE(4 * u_max * s * (1 - s), u[3 * (z * 2 * 3)], kExact, u_max);
            }
        }
    }

    void couette_is_exact_on_every_axis()
    {
        const int n = 8;
        const double U = 0.05;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const int along = (axis + 1) % 3;
                std::array<int, 3> cells{2, 2, 2};
                cells[axis] = n;
                FluidConfig c = test::lattice_config(cells, 0.9);
                test::walls(c, axis);
                c.faces[2 * axis + side].velocity[along] = U;
                Fluid fluid(c);
                for (int t = 0; t < 6000; ++t) fluid.step();
                for (int i = 0; i < n; ++i) {
                    Vec3 at{0.5, 0.5, 0.5};
                    at[axis] = i + 0.5;
                    const double s = at[axis] / n;
                    LBM_ASSERT_CLOSE(U * (side ? s : 1 - s), fluid.velocity_at(at)[along], kExact, U);
                }
            }
    }

    void a_drive_starts_a_channel_from_rest()
    {
        // u = G H^2 / (2 nu) (s - s^2 - sum over odd k of 8 / (k pi)^3 sin(k pi s) exp(-(k pi)^2 nu t / H^2))
        const int n = 16;
        FluidConfig c = test::lattice_config({2, 2, n}, 1.1);
        c.acceleration = {1e-5, 0, 0};
        test::walls(c, 2);
        Fluid fluid(c);
        CPPUNIT_ASSERT(fluid.average_velocity() == Vec3{});
        const double largest = 1e-5 * n * n / (8 * c.viscosity);
        for (int t = 1; t <= 200; ++t) {
            fluid.step();
            double exact = 0.25;
            for (int k = 1; k < 40; k += 2) {
                const double q = k * std::numbers::pi;
                exact -= 8 / (q * q * q) * (k % 4 == 1 ? 1 : -1) * std::exp(-q * q * c.viscosity * t / (n * n));
            }
            exact *= 4 * largest;
            const double u = fluid.velocity_at({1, 1, 0.5 * n})[0];
            LBM_ASSERT_CLOSE(exact, u, kStartUp, exact);
        }
    }

    void a_drive_against_walls_moves_nothing()
    {
        // Fluid that began with half a step of the drive would keep a part that turns round in each step, (-1)^(z + t), where the number of cells is odd.
        for (const int n : {7, 8}) {
            FluidConfig c = test::lattice_config({3, 2, n}, 1.5);
            c.acceleration = {1e-5, 0, 3e-5};
            c.inertia = false;
            test::walls(c, 2);
            Fluid fluid(c);
            for (int t = 0; t < 600; ++t) fluid.step();
            const auto u = fluid.velocity_field(), p = fluid.pressure_field();
            for (int z = 0; z < n; ++z) {
                LBM_ASSERT_CLOSE(0.0, u[3 * (z * 2 * 3) + 2], kRoundOff, u[3 * (n / 2 * 2 * 3)]);
                LBM_ASSERT_CLOSE(3e-5 * (z - 0.5 * (n - 1)), p[z * 2 * 3], kRoundOff, 3e-5 * n);
            }
        }
    }

    void mass_is_kept_in_closed_and_periodic_boxes()
    {
        for (int closed = 0; closed < 2; ++closed) {
            FluidConfig c = test::lattice_config({10, 9, 11}, 0.6);
            c.acceleration = {1e-4, 0, 2e-4};
            if (closed) {
                for (int axis = 0; axis < 3; ++axis) test::walls(c, axis);
                c.faces[kZMax].velocity = {0.05, 0, 0};
            }
            Solid s;
            s.radius = 2.7;
            s.position = {4, 4, 5};
            s.velocity = {0.01, 0, 0};
            Fluid fluid(c);
            const double mass = fluid.total_mass();
            for (int t = 0; t < 1000; ++t) {
                s.position[0] = 4 + 0.001 * t;
                fluid.place_solids({s});
                fluid.step();
            }
            LBM_ASSERT_CLOSE(mass, fluid.total_mass(), kRoundOff, mass);
        }
    }

    void a_box_whose_walls_move_together_carries_its_fluid()
    {
        FluidConfig c = test::lattice_config({7, 6, 5}, 0.8);
        test::walls(c, 1);
        test::walls(c, 2);
        for (const int face : {kYMin, kYMax, kZMin, kZMax}) c.faces[face].velocity = {0.04, 0, 0};
        Fluid fluid(c);
        for (int t = 0; t < 4000; ++t) fluid.step();
        const auto u = fluid.velocity_field();
        for (std::size_t cell = 0; cell < u.size() / 3; ++cell) LBM_ASSERT_CLOSE(0.04, u[3 * cell], kExact, 0.04);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Channel);

}  // namespace
