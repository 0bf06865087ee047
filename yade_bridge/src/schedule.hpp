#pragma once

#include <cmath>
#include <cstdint>

namespace yadelbm {

/**
 * When the fluid steps, seen from the grains' steps. Pure arithmetic.
 *
 * Grain step m covers [m dt, (m+1) dt). A fluid step is done in the grain step in which it begins, before the grains are
 * integrated. Time is counted in whole steps since the last change of a step, so that nothing drifts.
 */
class Schedule {
public:
    Schedule() = default;
    Schedule(double grain_dt, double fluid_dt) : grain_dt_(grain_dt), fluid_dt_(fluid_dt) {}

    double grain_dt() const noexcept { return grain_dt_; }
    double fluid_dt() const noexcept { return fluid_dt_; }

    /// Time by which the fluid is ahead of the start of the current grain step [s]; exactly 0 when it is within round-off.
    double lead() const noexcept
    {
        const double lead = lead_at_base_ + (fluid_steps_ * fluid_dt_ - grain_steps_ * grain_dt_);
        return std::abs(lead) < tolerance() ? 0.0 : lead;
    }

    /// Whether a fluid step begins in the current grain step.
    bool fluid_step_due() const noexcept { return lead() < grain_dt_ - tolerance(); }

    void fluid_stepped() noexcept { ++fluid_steps_; }
    void grains_stepped() noexcept { ++grain_steps_; }

    /// The grains made a step of another length than planned [s]: it counts as it was.
    void grains_stepped_by(double elapsed) noexcept
    {
        lead_at_base_ = lead() - elapsed;
        fluid_steps_ = grain_steps_ = 0;
    }

    /// From the current grain step on the grains' step is this long [s].
    void change_grain_dt(double grain_dt) noexcept
    {
        lead_at_base_ = lead();
        fluid_steps_ = grain_steps_ = 0;
        grain_dt_ = grain_dt;
    }

    /// From the next fluid step on the fluid's step is this long [s].
    void change_fluid_dt(double fluid_dt) noexcept
    {
        lead_at_base_ = lead();
        fluid_steps_ = grain_steps_ = 0;
        fluid_dt_ = fluid_dt;
    }

private:
    // far above the round-off of 10^9 steps counted in doubles, far below any step that matters
    double tolerance() const noexcept { return 1e-6 * std::fmin(grain_dt_, fluid_dt_); }

    double grain_dt_ = 0;
    double fluid_dt_ = 0;
    double lead_at_base_ = 0;
    std::int64_t fluid_steps_ = 0;
    std::int64_t grain_steps_ = 0;
};

}  // namespace yadelbm
