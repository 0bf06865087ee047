#include "facade/planning.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace lbm::planning {
namespace {

/// Contact frequency times fluid step above which the liquid hardly damps what rings (docs/physics.md, "Loads in time").
constexpr double kWantedContactPhase = 1;

/// What the same run would take with tau = 1, the usual choice, over what it takes now.
double work_at_tau_one(const PlanRequest& r, const StepEstimate& now)
{
    const double dt = fluid_time_step(1, r.dx, kinematic_viscosity(r));
    const double mach = kSqrt3 * r.speed * dt / r.dx;
    // Where that goes beyond the Mach number it takes a smaller dx, dt goes with dx^2 and the number of cells with dx^-3.
    const double finer = std::max(1.0, mach / r.max_mach);
    return now.fluid_dt / dt * std::pow(finer, 5);
}

/// The best, then some that differ by a third at least, so that the table shows the range.
std::vector<StepEstimate> worth_showing(const std::vector<StepEstimate>& ranking)
{
    constexpr std::size_t kRows = 6;
    std::vector<StepEstimate> shown;
    for (const StepEstimate& e : ranking) {
        const bool near = std::any_of(shown.begin(), shown.end(), [&](const StepEstimate& other) {
            return std::abs(std::log(e.fluid_dt / other.fluid_dt)) < std::log(1.33);
        });
        if (!near && shown.size() < kRows) shown.push_back(e);
    }
    return shown;
}

void print_ranking(std::ostringstream& out, const PlanRequest& r, const Plan& p)
{
    const auto percent = [](double error) {
        std::ostringstream text;
        text << std::setprecision(error < 0.01 ? 1 : 2) << 100 * error << " %";
        return text.str();
    };
    const auto steps = [](double n) { return n >= 1 ? message(n) : message("1/", 1 / n); };
    const auto row = [&](const auto&... column) {
        out << "  ";
        ((out << std::left << std::setw(12) << column), ...);
        out << '\n';
    };
    out << "  Ranking, of " << p.ranking.size() << " (error: flow + static + transients):\n";
    row("tau", "fluid step", "grain steps", "Mach", "error", "flow", "static", "transients", "s per s");
    for (const StepEstimate& e : worth_showing(p.ranking))
        row(e.tau, e.fluid_dt, steps(e.steps_per_fluid_step), e.mach,
            percent(e.estimated_error) + (e.estimated_error > r.accuracy ? " !" : ""), percent(e.compressibility_error),
            percent(e.static_compression), percent(e.transient_error), e.cost);
}

}  // namespace

std::string why_first(const PlanRequest& r, const StepEstimate& first)
{
    const double n = first.steps_per_fluid_step;
    if (n != std::round(n) && 1 / n != std::round(1 / n))
        return "no whole number of grain steps fits, so it goes by time";
    const std::string percent = message(100 * r.accuracy, " %");
    if (first.estimated_error > r.accuracy)
        return "no step within the accuracy of " + percent + " is stable, this one comes nearest";
    if (n == 1) return "one fluid step fits one grain step";
    if (n < 1) return "the grain step is too long for one fluid step within " + percent + ", so it is divided";
    return "the longest whole number of grain steps within the accuracy of " + percent;
}

std::vector<std::string> warnings(const PlanRequest& r, const Plan& p)
{
    std::vector<std::string> all;
    if (p.cells_per_diameter > 0 && p.cells_per_diameter < kWantedCellsPerDiameter)
        all.push_back(message("only ", p.cells_per_diameter, " cells per diameter of the smallest solid: at least ",
                              kWantedCellsPerDiameter, " are wanted for a drag within about 1 %"));
    const double cells = r.mean_diameter / r.dx;
    const double error = cells > 0 && p.reynolds > 0 ? resolution_error(cells, p.reynolds, 0) : 0;
    if (p.reynolds > 1 && error > kWantedResolutionError)
        all.push_back(message("the boundary layer of a grain with the Reynolds number ", p.reynolds, " is about ",
                              cells / std::sqrt(p.reynolds), " cells thick: its drag is some ", 100 * error,
                              " % too high; dx <= ", r.dx * std::sqrt(kWantedResolutionError / error),
                              " m would keep that below ", 100 * kWantedResolutionError, " %"));
    if (p.mach > 0.1 && p.mach <= r.max_mach)
        all.push_back(message("Mach number ", p.mach, ": compressibility changes the density by about ",
                              100 * p.compressibility_error, " %"));
    if (p.static_compression > 0.01)
        all.push_back(message(
            "a static pressure of ", r.static_pressure, " Pa compresses the lattice's fluid, whose bulk modulus is ",
            r.static_pressure / p.static_compression, " Pa, by ", 100 * p.static_compression,
            " %; tau <= ", 0.5 + (p.tau - 0.5) * std::sqrt(0.01 / p.static_compression), " would keep it below 1 %"));
    if (p.motion_per_step > 0.1)
        all.push_back(message("surfaces move up to ", p.motion_per_step,
                              " cells per fluid step: above 0.1 the load becomes noisy"));
    if (p.contact_phase > kWantedContactPhase) {
        const double tau = 0.5 + (p.tau - 0.5) * kWantedContactPhase / p.contact_phase;
        all.push_back(message("contacts ring with up to ", r.contact_frequency, " rad/s, ", p.contact_phase,
                              " times the inverse fluid step: above ", kWantedContactPhase,
                              " the liquid hardly damps them; use a contact law with damping of its own",
                              tau >= kMinTau ? message(", softer grains, or tau <= ", tau) : " or softer grains"));
    }
    return all;
}

std::string report(const PlanRequest& r, const Plan& p, const std::string& why)
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
    line("time", p.cost, " s per simulated second, at ", throughput(r) / 1e6, " million cell updates per second",
         r.throughput > 0 ? " (measured)" : " (assumed; `lbm bench` measures)");
    line("with tau = 1", work_at_tau_one(r, p), " times that");
    line("expected speed", r.speed, " m/s");
    line("Mach number", p.mach, " (limit ", r.max_mach, ")");
    line("compressibility error", 100 * p.compressibility_error, " % by the flow, ", 100 * p.static_compression,
         " % at rest");
    if (p.cells_per_diameter > 0) {
        line("Reynolds number", p.reynolds);
        line("cells per diameter", p.cells_per_diameter);
        line("surface motion", p.motion_per_step, " cells per fluid step");
        line("transients resolved above", p.shortest_transient, " s");
        if (std::isfinite(r.response_time)) line("grains respond in", r.response_time, " s");
    }
    line("viscous time", p.viscous_time, " s (R^2 / nu)");
    line("sound crosses the box in", p.acoustic_time, " s");
    if (p.contact_phase > 0) line("contact frequency x step", p.contact_phase);
    line("estimated error", 100 * p.estimated_error, " % (accuracy asked for: ", 100 * r.accuracy, " %)");
    print_ranking(out, r, p);
    for (const std::string& warning : p.warnings) out << "  warning: " << warning << '\n';
    return out.str();
}

}  // namespace lbm::planning
