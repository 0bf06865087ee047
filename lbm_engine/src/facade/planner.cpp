#include "lbm/planner.hpp"

#include "fields/populations.hpp"
#include "lattice/message.hpp"
#include "lattice/units.hpp"

#include <algorithm>
#include <iomanip>

namespace lbm {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
constexpr int kMaxFluidStepsPerGrainStep = 1000;

/// Sound crosses a solid this often before its load is settled to about 1 % (docs/physics.md, "Transients").
constexpr double kSoundCrossingsToSettle = 10;

/// Cells across a diameter below which drag errors of several per cent are to be expected.
constexpr double kWantedCellsPerDiameter = 8;

struct Step {
    double dt, ratio;  ///< ratio: grain steps in it
    const char* why;
};

double mach(const PlanRequest& r, double dt) { return kSqrt3 * r.speed * dt / r.dx; }

Step given_step(const PlanRequest& r, double nu)
{
    if (!(r.tau >= kMinTau && r.tau <= kMaxTau))
        throw ConfigError(message("tau = ", r.tau, ": must lie between ", kMinTau, " and ", kMaxTau,
                                  "; leave it out to have it chosen from the time step of the grains"));
    const double dt = fluid_time_step(r.tau, r.dx, nu);
    return {dt, dt / r.grain_dt, r.why_tau};
}

Step chosen_step(const PlanRequest& r, double nu)
{
    const double smallest_dt = fluid_time_step(kMinPlannedTau, r.dx, nu);
    // A hair of slack, so that a grain step that gives exactly the limit counts as one.
    const double ratio = std::max(1.0, std::ceil(smallest_dt / r.grain_dt * (1 - 1e-9)));
    const double dt = ratio * r.grain_dt;
    const double largest_dt = fluid_time_step(kMaxPlannedTau, r.dx, nu);
    const double mach_dt = r.speed > 0 ? r.max_mach * r.dx / (kSqrt3 * r.speed) : largest_dt;
    if (dt <= std::min(largest_dt, mach_dt))
        return {dt, ratio,
                ratio > 1 ? "the fewest grain steps for which tau is not too small"
                          : "one fluid step fits one grain step"};
    if (ratio == 1) {
        const double parts = std::ceil(r.grain_dt / std::min(largest_dt, mach_dt) * (1 - 1e-9));
        const double part = r.grain_dt / parts;
        if (parts <= kMaxFluidStepsPerGrainStep && part >= smallest_dt * (1 - 1e-9))
            return {part, 1 / parts, "the grain step is too long for one fluid step, so it is divided"};
    }
    if (mach(r, smallest_dt) > r.max_mach)
        throw ConfigError(message("Mach number ", mach(r, smallest_dt), " at the expected speed of ", r.speed,
                                  " m/s even with the smallest tau, ", kMinPlannedTau, ": above the limit ", r.max_mach,
                                  "; use dx <= ", r.dx * r.max_mach / mach(r, smallest_dt), " m, or raise maxMach"));
    // Any ratio works; whole ones are only neater.
    const double fits = std::min(largest_dt, mach_dt);
    return {fits, fits / r.grain_dt, "no whole number of grain steps fits, so it goes by time"};
}

double lattice_bytes(const std::array<int, 3>& cells)
{
    return double(Layout<D3Q19>(cells, sizeof(double)).slots) * sizeof(double);
}

std::vector<std::string> warnings(const PlanRequest& r, const Plan& p)
{
    std::vector<std::string> all;
    if (p.cells_per_diameter > 0 && p.cells_per_diameter < kWantedCellsPerDiameter)
        all.push_back(message("only ", p.cells_per_diameter, " cells per diameter of the smallest solid: at least ",
                              kWantedCellsPerDiameter, " are wanted for a drag within about 1 %"));
    if (p.tau > 1 && p.cells_per_diameter > 0)
        all.push_back(message("tau = ", p.tau, ": steady loads do not depend on it, but transients shorter than ",
                              p.shortest_transient, " s are not resolved"));
    if (p.mach > 0.1 && p.mach <= r.max_mach)
        all.push_back(message("Mach number ", p.mach, ": compressibility changes the density by about ",
                              100 * p.compressibility_error, " %"));
    if (p.motion_per_step > 0.1)
        all.push_back(message("surfaces move up to ", p.motion_per_step,
                              " cells per fluid step: above 0.1 the load becomes noisy"));
    return all;
}

std::string report(const PlanRequest& r, const Plan& p, const char* why)
{
    std::ostringstream out;
    out.precision(4);
    const auto line = [&](const char* name, const auto&... value) {
        out << "  " << std::left << std::setw(28) << name;
        (out << ... << value) << '\n';
    };
    out << "Fluid time step: " << why << '\n';
    line("tau", p.tau);
    line("fluid step", p.fluid_dt, " s");
    if (p.steps_per_fluid_step >= 1) line("grain steps per fluid step", p.steps_per_fluid_step);
    else line("fluid steps per grain step", 1 / p.steps_per_fluid_step);
    line("cells", r.cells[0], " x ", r.cells[1], " x ", r.cells[2], " (", p.memory_bytes / 1e6, " MB)");
    line("expected speed", r.speed, " m/s");
    line("Mach number", p.mach, " (limit ", r.max_mach, ")");
    line("compressibility error", 100 * p.compressibility_error, " %");
    if (p.cells_per_diameter > 0) {
        line("Reynolds number", p.reynolds);
        line("cells per diameter", p.cells_per_diameter);
        line("surface motion", p.motion_per_step, " cells per fluid step");
        line("transients resolved above", p.shortest_transient, " s");
    }
    for (const std::string& warning : p.warnings) out << "  warning: " << warning << '\n';
    return out.str();
}

}  // namespace

Plan plan_time_step(const PlanRequest& r)
{
    require_positive("dx", r.dx, "m");
    require_countable(r.cells);
    require_positive("density", r.density, "kg/m3");
    require_positive("viscosity", r.viscosity, "Pa s");
    require_positive("time step of the grains", r.grain_dt, "s");
    require_positive("maxMach", r.max_mach, "-");
    if (!(std::isfinite(r.speed) && r.speed >= 0))
        throw ConfigError(message("speed = ", r.speed, ": must be finite and >= 0 [m/s]"));

    const double nu = r.viscosity / r.density;
    const Step step = std::isnan(r.tau) ? chosen_step(r, nu) : given_step(r, nu);
    Plan p;
    p.tau = std::isnan(r.tau) ? relaxation_time(step.dt, r.dx, nu) : r.tau;
    p.fluid_dt = step.dt;
    p.steps_per_fluid_step = step.ratio;
    p.mach = mach(r, step.dt);
    if (p.mach > r.max_mach)
        throw ConfigError(message("Mach number ", p.mach, " at the expected speed of ", r.speed,
                                  " m/s with tau = ", p.tau, ": above the limit ", r.max_mach, "; use tau <= ",
                                  relaxation_time(step.dt * r.max_mach / p.mach, r.dx, nu), " or a smaller dx"));
    p.compressibility_error = p.mach * p.mach;
    p.motion_per_step = r.speed * step.dt / r.dx;
    if (std::isfinite(r.smallest_radius)) {
        p.reynolds = r.speed * r.mean_diameter / nu;
        p.cells_per_diameter = 2 * r.smallest_radius / r.dx;
        p.shortest_transient = kSoundCrossingsToSettle * kSqrt3 * r.smallest_radius / r.dx * step.dt;
    }
    p.memory_bytes = lattice_bytes(r.cells);
    p.warnings = warnings(r, p);
    p.report = report(r, p, step.why);
    return p;
}

}  // namespace lbm
