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
    CPPUNIT_TEST(an_unsteady_grain_shortens_the_step);
    CPPUNIT_TEST(the_weight_of_a_suspension_shortens_the_step);
    CPPUNIT_TEST(sets_are_ranked_as_stated);
    CPPUNIT_TEST(cost_is_cells_over_throughput);
    CPPUNIT_TEST(stiff_contacts_are_warned_about);
    CPPUNIT_TEST(a_cell_size_is_suggested_for_an_accuracy);
    CPPUNIT_TEST(resolution_errors_are_those_that_were_measured);
    CPPUNIT_TEST(a_grain_step_is_suggested_that_the_fluid_step_is_a_multiple_of);
    CPPUNIT_TEST(long_grain_steps_are_divided);
    CPPUNIT_TEST(grain_steps_of_very_many_fluid_steps_are_refused);
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
        // the error is Ma^2 here, 3 (0.03 dt / dx)^2 = 0.02 at 2721.66 grain steps
        CPPUNIT_ASSERT_EQUAL(2721.0, p.steps_per_fluid_step);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(2721e-6, p.fluid_dt, 1e-15);
        assert_says(p.report, "the longest whole number of grain steps within the accuracy of 2 %");
    }

    void an_unsteady_grain_shortens_the_step()
    {
        PlanRequest r = request(1e-6);
        r.response_time = 0.1;
        const Plan p = plan_time_step(r);
        const double transient = 10 * std::sqrt(3.0) * 7.5 * p.fluid_dt;
        CPPUNIT_ASSERT_DOUBLES_EQUAL(transient, p.shortest_transient, 1e-12);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.01 * std::pow(transient / 0.1, 1.3), p.transient_error, 1e-12);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(p.compressibility_error + p.transient_error, p.estimated_error, 1e-15);
        CPPUNIT_ASSERT(p.estimated_error <= 0.02 && p.estimated_error > 0.0199);
        r.accuracy = 0.005;
        CPPUNIT_ASSERT(plan_time_step(r).fluid_dt < 0.5 * p.fluid_dt);
    }

    void the_weight_of_a_suspension_shortens_the_step()
    {
        PlanRequest r = request(1e-6);
        r.speed = 0;
        r.static_pressure = 1500 * 0.4 * 9.81 * 0.16;
        const Plan p = plan_time_step(r);
        const double bulk_modulus = 1000 * 1e-6 / (3 * p.fluid_dt * p.fluid_dt);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(r.static_pressure / bulk_modulus, p.static_compression, 1e-12);
        CPPUNIT_ASSERT(p.static_compression <= 0.02 && p.static_compression > 0.0199);
        assert_says(p.report, "compresses the lattice's fluid, whose bulk modulus is");
        r.static_pressure *= 100;
        r.dx = 0.01;
        assert_says(says<ConfigError>([&] { plan_time_step(r); }), "static pressure of 94176 Pa would compress");
    }

    void sets_are_ranked_as_stated()
    {
        PlanRequest r = request(2e-4);  // tau 0.56: feasible, and not the cheapest
        const Plan p = plan_time_step(r);
        CPPUNIT_ASSERT(p.ranking.size() > 10);
        CPPUNIT_ASSERT_EQUAL(1.0, p.ranking[0].steps_per_fluid_step);
        for (std::size_t i = 2; i < p.ranking.size(); ++i) {
            const StepEstimate &a = p.ranking[i - 1], &b = p.ranking[i];
            const bool a_fits = a.estimated_error <= r.accuracy, b_fits = b.estimated_error <= r.accuracy;
            CPPUNIT_ASSERT(a_fits || !b_fits);
            if (a_fits && b_fits) CPPUNIT_ASSERT(a.cost < b.cost);
            if (!a_fits) CPPUNIT_ASSERT(a.estimated_error <= b.estimated_error);
        }
        CPPUNIT_ASSERT(p.ranking.back().estimated_error > r.accuracy);
        CPPUNIT_ASSERT(p.ranking.back().mach <= r.max_mach && p.ranking.back().tau <= kMaxPlannedTau);
        assert_says(p.report, "Ranking, of ");
    }

    void cost_is_cells_over_throughput()
    {
        PlanRequest r = request(1e-3);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(1.6e6 / 1e8 / 1e-3, plan_time_step(r).cost, 1e-9);
        assert_says(plan_time_step(r).report, "100 million cell updates per second (assumed");
        r.throughput = 4e7;
        CPPUNIT_ASSERT_DOUBLES_EQUAL(1.6e6 / 4e7 / 1e-3, plan_time_step(r).cost, 1e-9);
        assert_says(plan_time_step(r).report, "40 million cell updates per second (measured)");
    }

    void stiff_contacts_are_warned_about()
    {
        PlanRequest r = request(1e-3);
        r.contact_frequency = 900;
        CPPUNIT_ASSERT(plan_time_step(r).warnings.empty());
        r.contact_frequency = 3000;
        const Plan p = plan_time_step(r);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(3.0, p.contact_phase, 1e-12);
        assert_says(p.report, "contacts ring with up to 3000 rad/s");
        assert_says(p.report, "or tau <= 0.6");  // a third of 0.3
    }

    void a_cell_size_is_suggested_for_an_accuracy()
    {
        PlanRequest r = request(1e-3);
        r.accuracy = 0.01;
        r.smallest_radius = 0.5 * (r.mean_diameter = 8e-3);
        r.speed = 1e-3;
        const Vec3 box{0.1, 0.1, 0.16};
        const double dx = suggest_dx(r, box);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.001, dx, 1e-12);  // the least of 8 cells; divides the box
        r.accuracy = 1e-3;
        const double fine = suggest_dx(r, box);
        CPPUNIT_ASSERT(resolution_error(8e-3 / fine, 1e-3 * 8e-3 / 1e-4, 0) <= 1e-3);
        for (const double length : box)
            CPPUNIT_ASSERT_DOUBLES_EQUAL(std::round(length / fine), length / fine, 1e-6 * length / fine);
        CPPUNIT_ASSERT(suggest_dx(r, box, 0.3) < 0.5 * fine);  // narrow gaps
        const auto refused = says<ConfigError>([&] { suggest_dx(r, box, 0, {5e8}); });
        assert_says(refused, "beyond the budget of 0.5 GB");
        r.accuracy =
            1.2 * std::stod(refused.substr(refused.rfind("accuracy = ") + 11));  // 1.2: the box wants whole cells
        CPPUNIT_ASSERT(suggest_dx(r, box, 0, {5e8}) > fine);
        assert_says(says<ConfigError>([&] { suggest_dx(r, {0.1, 0.1, 0.1 * std::sqrt(2)}); }), "no cell size near");
    }

    void resolution_errors_are_those_that_were_measured()
    {
        // docs/physics.md, "Which cell size": sphere in a cubic array, and in a box at Re = 30
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.0022, resolution_error(8.6, 0, 0), 0.0005);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.0066, resolution_error(8.93, 0, 0.216), 0.001);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.0120, resolution_error(8.68, 0, 0.343), 0.004);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.0084, resolution_error(12.16, 0, 0.343), 0.002);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.013, resolution_error(8, 0, 0.6), 0.005);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.0266, resolution_error(9.75, 30.5, 0), 0.006);
    }

    void a_grain_step_is_suggested_that_the_fluid_step_is_a_multiple_of()
    {
        PlanRequest r = request(0);
        r.response_time = 0.1;
        const double dt = suggest_dt(r, 5e-5);
        CPPUNIT_ASSERT(dt <= 5e-5 && dt > 4e-5);
        r.grain_dt = dt;
        const Plan p = plan_time_step(r);
        CPPUNIT_ASSERT(p.estimated_error > 0.0199);  // all of the accuracy is used
        CPPUNIT_ASSERT_EQUAL(std::ceil(p.fluid_dt / 5e-5), p.steps_per_fluid_step);
        CPPUNIT_ASSERT_EQUAL(1.0, [&] {
            r.grain_dt = suggest_dt(r, 1.0);
            return plan_time_step(r).steps_per_fluid_step;
        }());
        assert_says(says<ConfigError>([&] {
                        suggest_dt(r, 5e-5, {PlanRequest::kInfinity, 1.0});
                    }),
                    "beyond the budget of 1 s");
        assert_says(says<ConfigError>([&] { suggest_dt(r, 0); }), "largest time step of the grains = 0");
    }

    void long_grain_steps_are_divided()
    {
        const Plan p = plan_time_step(request(0.02));
        CPPUNIT_ASSERT(p.tau <= kMaxPlannedTau && p.mach <= 0.2);
        CPPUNIT_ASSERT_DOUBLES_EQUAL(0.02, p.fluid_dt * std::round(1 / p.steps_per_fluid_step), 1e-15);
    }

    void grain_steps_of_very_many_fluid_steps_are_refused()
    {
        const Plan p = plan_time_step(request(1));
        CPPUNIT_ASSERT(p.fluid_dt > 1 / kMaxFluidStepsPerGrainStep);
        const std::string said = says<ConfigError>([] { plan_time_step(request(1e3)); });
        assert_says(said, "time step of the grains = 1000 s: holds ");
        assert_says(said, "at most 10000 are possible; use one of at most ");
        PlanRequest given = request(1e3);
        given.tau = 1;
        assert_says(says<ConfigError>([&] { plan_time_step(given); }), "(tau = 1), at most 10000");
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
        assert_says(plan_error([](auto& r) { r.accuracy = 0; }), "accuracy = 0");
        assert_says(plan_error([](auto& r) { r.response_time = 0; }), "response_time = 0");
        assert_says(plan_error([](auto& r) {
                        r.tau = 2;
                        r.speed = 0;
                        r.static_pressure = 1e3;
                    }),
                    "above the limit 20 %; use tau <= ");
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
        r.viscosity = 0.005;
        assert_says(plan_time_step(r).report,
                    "the boundary layer of a grain with the Reynolds number 90 is about 1.58");
        r = request(1e-3);
        r.smallest_radius = 3e-3;
        assert_says(plan_time_step(r).report, "only 6 cells per diameter");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Planner);

}  // namespace
