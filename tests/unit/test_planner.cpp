#include "says.hpp"

#include "lbm/planner.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <limits>

namespace {

using namespace lbm;
using lbm::test::assert_says;
using lbm::test::says;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Planner : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Planner);
    CPPUNIT_TEST(one_fluid_step_per_grain_step_where_the_limits_allow);
    CPPUNIT_TEST(short_grain_steps_are_gathered);
    CPPUNIT_TEST(long_grain_steps_are_divided);
    CPPUNIT_TEST(a_given_tau_is_kept);
    CPPUNIT_TEST(violated_limits_are_named_with_a_remedy);
    CPPUNIT_TEST(remedies_work);
    CPPUNIT_TEST(doubtful_choices_are_warned_about);
    CPPUNIT_TEST_SUITE_END();

    static PlanRequest request(double grain_dt)
    {
        PlanRequest r;
        r.cells = {100, 100, 160};
        r.dx = 1e-3;
        r.density = 1000;
        r.viscosity = 0.1;
        r.grain_dt = grain_dt;
        r.speed = 0.03;
        r.smallest_radius = 7.5e-3;
        r.mean_diameter = 15e-3;
        return r;
    }

    void one_fluid_step_per_grain_step_where_the_limits_allow()
    {
        const Plan p = plan_time_step(request(1e-3));  // tau = 0.5 + 3 * 1e-4 * 1e-3 / 1e-6 = 0.8
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.8, p.tau, 1e-12);
        CPPUNIT_ASSERT_EQUAL(1.0, p.steps_per_fluid_step);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.03 * 1.7320508 * 1e-3 / 1e-3, p.mach, 1e-8);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.03 * 15e-3 / 1e-4, p.reynolds, 1e-9);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(15.0, p.cells_per_diameter, 1e-12);
        assert_says(p.report, "one fluid step fits one grain step");
    }

    void short_grain_steps_are_gathered()
    {
        const Plan p = plan_time_step(request(1e-6));
        CPPUNIT_ASSERT_EQUAL(67.0, p.steps_per_fluid_step);  // 0.02 / 3e-4
        CPPUNIT_ASSERT(p.tau >= kMinPlannedTau);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(67e-6, p.fluid_dt, 1e-18);
    }

    void long_grain_steps_are_divided()
    {
        const Plan p = plan_time_step(request(0.02));
        CPPUNIT_ASSERT(p.tau <= kMaxPlannedTau && p.mach <= 0.2);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.02, p.fluid_dt * std::round(1 / p.steps_per_fluid_step), 1e-15);
    }

    void a_given_tau_is_kept()
    {
        PlanRequest r = request(1e-6);
        r.tau = 1.3;
        const Plan p = plan_time_step(r);
        CPPUNIT_ASSERT_EQUAL(1.3, p.tau);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.8 / 3 * 1e-6 / 1e-4, p.fluid_dt, 1e-15);
    }

    static std::string plan_error(const std::function<void(PlanRequest&)>& spoil)
    {
        PlanRequest r = request(1e-3);
        spoil(r);
        return says<ConfigError>([&] { plan_time_step(r); });
    }

    void violated_limits_are_named_with_a_remedy()
    {
        assert_says(plan_error([](auto& r) { r.tau = 0.5; }), "tau = 0.5: must lie between 0.505 and 20");
        assert_says(plan_error([](auto& r) { r.speed = 1e3; }), "above the limit 0.2; use dx <= ");
        assert_says(plan_error([](auto& r) {
                        r.tau = 2;
                        r.speed = 1;
                    }),
                    "use tau <= ");
        assert_says(plan_error([](auto& r) { r.dx = kNaN; }), "dx = nan");
        assert_says(plan_error([](auto& r) { r.viscosity = -1; }), "viscosity = -1");
        assert_says(plan_error([](auto& r) { r.grain_dt = 0; }), "time step of the grains = 0");
        assert_says(plan_error([](auto& r) { r.speed = kNaN; }), "speed = nan");
    }

    void remedies_work()
    {
        const std::string message = plan_error([](auto& r) { r.speed = 10; });
        const double dx = std::stod(message.substr(message.find("dx <= ") + 6));
        PlanRequest r = request(1e-6);
        r.speed = 10;
        r.dx = 0.99 * dx;
        r.grain_dt = 1e-9;
        CPPUNIT_ASSERT(plan_time_step(r).mach <= 0.2);
    }

    void doubtful_choices_are_warned_about()
    {
        PlanRequest r = request(1e-3);
        CPPUNIT_ASSERT(plan_time_step(r).warnings.empty());
        r.smallest_radius = 3e-3;
        assert_says(plan_time_step(r).report, "only 6 cells per diameter");
        r.tau = 1.5;
        assert_says(plan_time_step(r).report, "are not resolved");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Planner);

}  // namespace
