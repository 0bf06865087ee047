#include "lattice_units.hpp"
#include "says.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <limits>

namespace {

using namespace lbm;
using lbm::test::assert_says;
using lbm::test::says;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class BadInput : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(BadInput);
    CPPUNIT_TEST(configuration_names_the_value_and_the_rule);
    CPPUNIT_TEST(solids_are_named_by_their_id);
    CPPUNIT_TEST(a_refused_placement_leaves_the_fluid_as_it_was);
    CPPUNIT_TEST(a_surface_that_is_too_fast_stops_before_the_step);
    CPPUNIT_TEST(divergence_and_mach_limit_end_the_run_with_place_and_time);
    CPPUNIT_TEST(stokes_flow_bears_any_pressure);
    CPPUNIT_TEST(positions_outside_the_box_are_refused);
    CPPUNIT_TEST(unwritable_files_are_reported);
    CPPUNIT_TEST_SUITE_END();

    static std::string config_error(const std::function<void(FluidConfig&)>& spoil)
    {
        FluidConfig c = test::lattice_config({10, 10, 10}, 0.8);
        spoil(c);
        return says<ConfigError>([&] { Fluid fluid(c); });
    }

    void configuration_names_the_value_and_the_rule()
    {
        for (const double bad : {-1.0, 0.0, kNaN, std::numeric_limits<double>::infinity()}) {
            assert_says(config_error([&](auto& c) { c.dx = bad; }), "dx = ");
            assert_says(config_error([&](auto& c) { c.density = bad; }), "must be finite and > 0 [kg/m3]");
            assert_says(config_error([&](auto& c) { c.viscosity = bad; }), "viscosity = ");
            assert_says(config_error([&](auto& c) { c.max_mach = bad; }), "max_mach = ");
        }
        assert_says(config_error([](auto& c) { c.tau = 0.5; }), "must lie between 0.505 and 20");
        assert_says(config_error([](auto& c) { c.tau = kNaN; }), "tau = nan");
        assert_says(config_error([](auto& c) { c.tau = 21; }), "tau = 21");
        assert_says(config_error([](auto& c) { c.magic_parameter = -0.1; }), "magic_parameter = -0.1");
        assert_says(config_error([](auto& c) { c.magic_parameter = 0.51; }), "must lie between 0.01 and 0.5");
        assert_says(config_error([](auto& c) { c.cells[1] = 0; }), "cells along y = 0");
        assert_says(config_error([](auto& c) { c.cells = {2000000, 2000, 2000}; }), "use a larger dx");
        assert_says(config_error([](auto& c) { c.gravity[2] = kNaN; }), "gravity = ");
        assert_says(config_error([](auto& c) { c.acceleration[0] = kNaN; }), "acceleration = ");
        assert_says(config_error([](auto& c) { c.threads = -1; }), "threads = -1");
        for (const double lower : {1e13, -1e300})
            assert_says(config_error([&](auto& c) { c.lower[1] = lower; }), "move the origin nearer to the box");
        // Products of these would be zero or infinite, and flows silently nought.
        assert_says(config_error([](auto& c) { c.density = 1e-200, c.viscosity = 1e100; }), "are these SI units?");
        assert_says(config_error([](auto& c) { c.dx = 1e-100; }), "dx = 1e-100 m, density = 1 kg/m3");
        assert_says(config_error([](auto& c) { c.faces[kXMin].type = FaceType::no_slip; }),
                    "boundary along x: one face is periodic");
        assert_says(config_error([](auto& c) {
                        c.faces[kXMin].velocity = {0, 1, 0};
                    }),
                    "only a velocity face or a moving no-slip wall has one");
        assert_says(config_error([](auto& c) {
                        test::walls(c, 2);
                        c.faces[kZMax].velocity = {0, 0, 0.1};
                    }),
                    "a wall can only move in its own plane");
    }

    static std::string solid_error(const std::function<void(Solid&)>& spoil)
    {
        Fluid fluid(test::lattice_config({10, 10, 10}, 0.8));
        Solid s;
        s.id = 42;
        s.radius = 3;
        s.position = {5, 5, 5};
        spoil(s);
        return says<ConfigError>([&] { fluid.place_solids({s}); });
    }

    void solids_are_named_by_their_id()
    {
        assert_says(solid_error([](Solid& s) { s.radius = 1.9; }),
                    "solid 42: radius = 1.9 m is 1.9 cells: must be at least 2 cells");
        assert_says(solid_error([](Solid& s) { s.radius = 5.1; }), "larger than the box along x");
        assert_says(solid_error([](Solid& s) { s.radius = kNaN; }), "radius = nan");
        assert_says(solid_error([](Solid& s) { s.radius = -3; }), "radius = -3");
        assert_says(solid_error([](Solid& s) { s.position[1] = kNaN; }), "position is not finite");
        assert_says(solid_error([](Solid& s) { s.velocity[1] = kNaN; }), "velocity is not finite");
        assert_says(solid_error([](Solid& s) { s.angular_velocity[1] = kNaN; }), "angular velocity is not finite");
        assert_says(solid_error([](Solid& s) { s.mass = 0; }), "mass = 0");
        assert_says(solid_error([](Solid& s) { s.inertia = kNaN; }), "moment of inertia = nan");
        Fluid fluid(test::lattice_config({10, 10, 10}, 0.8));
        Solid s;
        s.id = 42;
        s.radius = 3;
        assert_says(says<ConfigError>([&] { fluid.place_solids({s, s}); }), "solid 42: this id is given twice");
    }

    void a_refused_placement_leaves_the_fluid_as_it_was()
    {
        Fluid fluid(test::lattice_config({10, 10, 10}, 0.8));
        Solid s;
        s.radius = 3;
        s.position = {5, 5, 5};
        fluid.place_solids({s});
        const auto before = fluid.solid_fraction_field();
        Solid bad = s;
        bad.id = 1;
        bad.radius = 1;
        CPPUNIT_ASSERT_THROW(fluid.place_solids({bad, s}), ConfigError);
        fluid.step();
        CPPUNIT_ASSERT(before == fluid.solid_fraction_field());
        CPPUNIT_ASSERT_EQUAL(std::size_t{1}, fluid.loads().size());
    }

    void divergence_and_mach_limit_end_the_run_with_place_and_time()
    {
        FluidConfig c = test::lattice_config({10, 10, 10}, 0.8);
        c.acceleration = {0.01, 0, 0};
        const auto run = [&] {
            Fluid fluid(c);
            Solid s;
            s.radius = 3;
            fluid.place_solids({s});
            for (int t = 0; t < 1000; ++t) fluid.step();
        };
        assert_says(says<RunError>(run), "is above the limit 0.2");
        assert_says(says<RunError>(run), "at step ");
        c.max_mach = 1e9;
        c.acceleration = {1, 0, 0};
        assert_says(says<RunError>(run), "the density is off by ");
        assert_says(says<RunError>(run), "above the limit of 50 %");
        c.acceleration = {1e200, 0, 0};
        assert_says(says<RunError>(run), "diverged at step ");
    }

    void a_surface_that_is_too_fast_stops_before_the_step()
    {
        Fluid fluid(test::lattice_config({12, 12, 12}, 0.8));
        Solid s;
        s.id = 17;
        s.radius = 3;
        s.position = {6, 6, 6};
        s.velocity = {0.03, 0, 0.03};
        s.angular_velocity = {0, 0.03, 0};  // with the velocity 0.042 + 0.09 cells per step, Mach 0.23
        fluid.place_solids({s});
        const auto before = fluid.velocity_field();
        const auto message = says<RunError>([&] { fluid.step(); });
        assert_says(message, "solid 17 at (6, 6, 6) before step 1 (t = 0 s): its surface moves at 0.1324264 m/s");
        assert_says(message, "Mach number 0.2293693 is above the limit 0.2");
        CPPUNIT_ASSERT(before == fluid.velocity_field());
        s.angular_velocity = {0.04, 0, 0.04};  // along the velocity: the speeds add up as squares, Mach 0.3
        s.velocity = {0.02, 0, 0.02};
        fluid.place_solids({s});
        assert_says(says<RunError>([&] { fluid.step(); }), "Mach number 0.2979");
        s.position = {-60, 6, 6};  // not in the fluid
        FluidConfig c = test::lattice_config({12, 12, 12}, 0.8);
        test::walls(c, 0);
        Fluid walled(c);
        walled.place_solids({s});
        walled.step();
    }

    void stokes_flow_bears_any_pressure()
    {
        FluidConfig c = test::lattice_config({8, 4, 4}, 0.8);
        c.inertia = false;
        c.faces[kXMin].type = c.faces[kXMax].type = FaceType::pressure;
        c.faces[kXMin].pressure = c.faces[kXMax].pressure = 1;  // three times what the density at rest gives
        Fluid fluid(c);
        for (int t = 0; t < 10; ++t) fluid.step();
        CPPUNIT_ASSERT(std::abs(fluid.pressure_at({4, 2, 2}) - 1) < 1e-12);
        c.inertia = true;
        assert_says(says<ConfigError>([&] { Fluid{c}; }), "changes the density by 300 %");
    }

    void positions_outside_the_box_are_refused()
    {
        const Fluid fluid(test::lattice_config({10, 10, 10}, 0.8));
        assert_says(says<ConfigError>([&] {
                        fluid.velocity_at({5, -0.1, 5});
                    }),
                    "position -0.1 m along y is outside the box, 0 to 10 m");
        assert_says(says<ConfigError>([&] { fluid.pressure_at({5, 5, kNaN}); }), "along z is outside");
    }

    void unwritable_files_are_reported()
    {
        const Fluid fluid(test::lattice_config({4, 4, 4}, 0.8));
        assert_says(says<RunError>([&] { fluid.save_vtk("/nowhere/at/all.vti"); }), "cannot write /nowhere/at/all.vti");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(BadInput);

}  // namespace
