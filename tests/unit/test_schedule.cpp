#include "../../yade_bridge/src/schedule.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>

namespace {

using yadelbm::Schedule;

class TwoClocks : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(TwoClocks);
    CPPUNIT_TEST(whole_ratios_keep_their_rhythm_for_a_million_steps);
    CPPUNIT_TEST(other_ratios_are_never_a_step_early_or_late);
    CPPUNIT_TEST(changes_of_the_steps_leave_no_drift);
    CPPUNIT_TEST_SUITE_END();

    static constexpr std::int64_t kSteps = 1'000'000;

    /// Fluid steps in one grain step.
    static int advance(Schedule& s)
    {
        int done = 0;
        for (; s.fluid_step_due(); ++done) s.fluid_stepped();
        s.grains_stepped();
        return done;
    }

    void whole_ratios_keep_their_rhythm_for_a_million_steps()
    {
        for (const double dt : {1e-5, 1.0 / 3, 7.7e-9})
            for (const int n : {1, 2, 3, 7, 50}) {
                Schedule s(dt, n * dt);
                for (std::int64_t step = 0; step < kSteps; ++step) CPPUNIT_ASSERT_EQUAL(int(step % n == 0), advance(s));
                Schedule parts(dt, dt / n);
                for (std::int64_t step = 0; step < kSteps / 10; ++step) CPPUNIT_ASSERT_EQUAL(n, advance(parts));
            }
    }

    void other_ratios_are_never_a_step_early_or_late()
    {
        const double dt = 1.1e-4;
        for (const double ratio : {std::sqrt(2.0), 0.3 * std::sqrt(5.0), 17.3}) {
            Schedule s(dt, ratio * dt);
            std::int64_t fluid_steps = 0;
            for (std::int64_t step = 0; step < kSteps; ++step) {
                fluid_steps += advance(s);
                // as many as begin before the end of this grain step; which end is meant is open within a millionth of a step
                const double begun = (step + 1) / ratio;
                CPPUNIT_ASSERT(fluid_steps >= std::ceil(begun - 3e-6) && fluid_steps <= std::ceil(begun + 3e-6));
            }
        }
    }

    void changes_of_the_steps_leave_no_drift()
    {
        double dt = 1e-4, fluid_dt = 3e-4;
        Schedule s(dt, fluid_dt);
        long double grains = 0, fluid = 0;
        for (std::int64_t step = 0; step < kSteps; ++step) {
            if (step % 7 == 3) s.change_grain_dt(dt = 1e-4 * (1 + 0.5 * std::sin(0.001 * step)));
            for (; s.fluid_step_due(); fluid += fluid_dt) {
                if (step % 1000 == 0) s.change_fluid_dt(fluid_dt = 3e-4 * (1 + 0.3 * std::cos(step)));
                s.fluid_stepped();
            }
            if (step % 11 == 5) s.grains_stepped_by(0.9 * dt), grains += 0.9 * dt;
            else s.grains_stepped(), grains += dt;
            CPPUNIT_ASSERT_DOUBLES_EQUAL(double(fluid - grains), s.lead(), 1e-9 * fluid_dt * (1 + step / 1000));
        }
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(TwoClocks);

}  // namespace
