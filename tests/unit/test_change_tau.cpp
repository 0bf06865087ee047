#include "close.hpp"
#include "lattice/vec3.hpp"
#include "lattice_units.hpp"
#include "says.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <numbers>

namespace {

using namespace lbm;

constexpr double kRoundOff = 1e-12;

/// Steady Stokes flow is carried over exactly; what remains is how steady it was.
constexpr double kSteady = 1e-9;

/// Flow that is not steady, or has inertia: the state of the new time step is met to this part of the speed.
constexpr double kUnsteady = 2e-3;

class ChangeTau : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(ChangeTau);
    CPPUNIT_TEST(steady_drag_velocity_and_pressure_do_not_jump);
    CPPUNIT_TEST(drag_in_a_duct_does_not_jump_with_inertia);
    CPPUNIT_TEST(moving_walls_and_free_spheres_go_on_as_before);
    CPPUNIT_TEST(momentum_is_kept_after_a_change);
    CPPUNIT_TEST(time_goes_on_in_the_new_steps);
    CPPUNIT_TEST(going_there_and_back_changes_nothing);
    CPPUNIT_TEST(what_does_not_fit_is_refused_and_changes_nothing);
    CPPUNIT_TEST_SUITE_END();

    void steady_drag_velocity_and_pressure_do_not_jump()
    {
        for (const double lambda : {0.125, 0.1875})
            for (int odd = 0; odd < 2; ++odd) {
                FluidConfig c = test::lattice_config({10, 10, 10}, 0.8);
                c.acceleration = {1e-6, 0, 0};
                c.inertia = false;
                c.magic_parameter = lambda;
                Fluid fluid(c);
                Solid s;
                s.radius = 3.1;
                s.position = {5.1, 5, 5};
                fluid.place_solids({s});
                for (int t = 0; t < 12000 + odd; ++t) fluid.step();
                const double force = fluid.loads()[0].force[0], u = fluid.average_velocity()[0];
                const double p = fluid.pressure_at({1, 2, 3});
                for (const double tau : {2.4, 0.6}) {
                    fluid.change_tau(tau);
                    LBM_ASSERT_CLOSE(u, fluid.average_velocity()[0], kSteady, u);
                    for (int t = 0; t < 50; ++t) {
                        fluid.step();
                        LBM_ASSERT_CLOSE(force, fluid.loads()[0].force[0], kSteady, force);
                    }
                    LBM_ASSERT_CLOSE(u, fluid.average_velocity()[0], kSteady, u);
                    LBM_ASSERT_CLOSE(p, fluid.pressure_at({1, 2, 3}), 1e-4, p);
                }
            }
    }

    /// With inertia the flow differs by its compressibility, of the order of the Mach number squared: 5e-8 here.
    void drag_in_a_duct_does_not_jump_with_inertia()
    {
        constexpr double kNextStep = 1e-3, kSettled = 1e-6;
        FluidConfig c = test::lattice_config({14, 12, 11}, 0.6);
        c.acceleration = {2e-7, 0, 0};
        test::walls(c, 1);
        test::walls(c, 2);
        Fluid fluid(c);
        Solid s;
        s.radius = 3.2;
        s.position = {7.1, 5.8, 5.6};
        fluid.place_solids({s});
        for (int t = 0; t < 20000; ++t) fluid.step();
        const double force = fluid.loads()[0].force[0];
        fluid.change_tau(0.8);  // the time step becomes three times as long
        fluid.step();
        LBM_ASSERT_CLOSE(force, fluid.loads()[0].force[0], kNextStep, force);
        for (int t = 0; t < 3000; ++t) fluid.step();
        LBM_ASSERT_CLOSE(force, fluid.loads()[0].force[0], kSettled, force);
    }

    /// A sphere carried along in a Couette flow.
    struct Carried {
        Fluid fluid;
        Solid sphere;

        Carried()
            : fluid([] {
                FluidConfig c = test::lattice_config({14, 12, 16}, 0.8);
                test::walls(c, 2);
                c.faces[kZMax].velocity = {0.03, 0, 0};
                return c;
            }())
        {
            sphere.radius = 2.7;
            sphere.position = {7, 6, 9};
            sphere.mass = 2 * 4 * std::numbers::pi / 3 * std::pow(sphere.radius, 3);
            sphere.inertia = 0.4 * sphere.mass * sphere.radius * sphere.radius;
        }
        void advance(double duration)
        {
            for (const double end = fluid.time() + duration; fluid.time() < end - 1e-9;) {
                const double dt = fluid.dt();
                fluid.place_solids({sphere});
                fluid.step();
                sphere.velocity += (dt / sphere.mass) * fluid.loads()[0].force;
                sphere.angular_velocity += (dt / sphere.inertia) * fluid.loads()[0].torque;
                sphere.position += dt * sphere.velocity;
            }
        }
    };

    void moving_walls_and_free_spheres_go_on_as_before()
    {
        Carried straight, changed;
        straight.advance(1500);
        changed.advance(1500);
        changed.fluid.change_tau(1.4);  // three times the step
        LBM_ASSERT_CLOSE(straight.fluid.velocity_at({3, 6, 15.5})[0], changed.fluid.velocity_at({3, 6, 15.5})[0],
                         kUnsteady, 0.03);
        straight.advance(300);
        changed.advance(300);
        changed.fluid.change_tau(0.7);
        straight.advance(300);
        changed.advance(300);
        LBM_ASSERT_CLOSE(straight.sphere.velocity[0], changed.sphere.velocity[0], kUnsteady,
                         straight.sphere.velocity[0]);
        LBM_ASSERT_CLOSE(straight.sphere.position[0], changed.sphere.position[0], 0.005, 2 * straight.sphere.radius);
    }

    void momentum_is_kept_after_a_change()
    {
        Fluid fluid(test::lattice_config({14, 13, 12}, 0.7));
        Solid s;
        s.radius = 2.9;
        s.position = {7, 6, 6};
        s.velocity = {0.02, 0.01, 0};
        s.mass = s.inertia = 250;
        const auto total = [&] { return fluid.total_momentum() + s.mass * s.velocity; };
        const auto advance = [&] {
            fluid.place_solids({s});
            fluid.step();
            s.velocity += (fluid.dt() / s.mass) * fluid.loads()[0].force;
            s.position += fluid.dt() * s.velocity;
        };
        for (int t = 0; t < 60; ++t) advance();
        fluid.change_tau(1.1);
        const Vec3 before = total();
        for (int t = 0; t < 60; ++t) advance();
        for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(before[d], total()[d], kRoundOff, s.mass * 0.02);
    }

    void time_goes_on_in_the_new_steps()
    {
        Fluid fluid(test::lattice_config({4, 4, 4}, 0.8));
        for (int t = 0; t < 7; ++t) fluid.step();
        fluid.change_tau(1.4);
        LBM_ASSERT_CLOSE(3.0, fluid.dt(), kRoundOff, 3.0);
        for (int t = 0; t < 2; ++t) fluid.step();
        LBM_ASSERT_CLOSE(13.0, fluid.time(), kRoundOff, 13.0);
        CPPUNIT_ASSERT_EQUAL(std::int64_t{9}, fluid.steps());
    }

    void going_there_and_back_changes_nothing()
    {
        Carried carried;
        carried.advance(301);
        const auto before = carried.fluid.velocity_field();
        carried.fluid.change_tau(1.7);
        carried.fluid.change_tau(0.8);
        const auto after = carried.fluid.velocity_field();
        for (std::size_t i = 0; i < before.size(); ++i) LBM_ASSERT_CLOSE(before[i], after[i], kRoundOff, 0.03);
    }

    void what_does_not_fit_is_refused_and_changes_nothing()
    {
        Carried carried;
        carried.advance(200);
        const auto before = carried.fluid.velocity_field();
        test::assert_says(test::says<ConfigError>([&] { carried.fluid.change_tau(0.4); }),
                          "tau = 0.4: must lie between");
        test::assert_says(test::says<ConfigError>([&] { carried.fluid.change_tau(5); }),
                          "above the limit 0.2; use tau <= ");
        CPPUNIT_ASSERT(before == carried.fluid.velocity_field());
        LBM_ASSERT_CLOSE(1.0, carried.fluid.dt(), kRoundOff, 1.0);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(ChangeTau);

}  // namespace
