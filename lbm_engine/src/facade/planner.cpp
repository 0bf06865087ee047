#include "lbm/planner.hpp"

#include "fields/populations.hpp"
#include "lattice/message.hpp"
#include "lattice/units.hpp"

#include <algorithm>
#include <iomanip>

namespace lbm {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
constexpr double kPi = 3.14159265358979323846;
constexpr double kHair = 1e-9;  // so that a step that gives exactly a limit meets it
constexpr int kMaxFluidStepsPerGrainStep = 1000;

/// Sound crosses a solid this often before its load is settled to about 1 % (docs/physics.md, "Transients").
constexpr double kSoundCrossingsToSettle = 10;

/// Error of a transient of just the time that is called resolved, and the power with which it grows for shorter ones: a fit to
/// spheres released from rest (docs/physics.md, "Which time step").
constexpr double kErrorOfResolvedTransient = 0.01;
constexpr double kTransientPower = 1.3;

/// Relative density change by the static pressure beyond which the fluid is not nearly incompressible any more.
constexpr double kMaxStaticCompression = 0.2;

/// Where nothing is known of the speeds, the Mach number cannot be foreseen: longer steps have to be asked for.
constexpr double kMaxTauWithoutSpeed = 1;

/// Cells across a diameter below which drag errors of several per cent are to be expected.
constexpr double kWantedCellsPerDiameter = 8;
constexpr double kWantedResolutionError = 0.02;

/// Contact frequency times fluid step above which the liquid hardly damps what rings (docs/physics.md, "Loads in time").
constexpr double kWantedContactPhase = 1;

double kinematic_viscosity(const PlanRequest& r) { return r.viscosity / r.density; }
double cell_count(const std::array<int, 3>& cells) { return double(cells[0]) * cells[1] * cells[2]; }
double populations(Lattice lattice) { return lattice == Lattice::d3q27 ? D3Q27::Q : D3Q19::Q; }
double bytes_per_population(Storage storage)
{
    return storage == Storage::single_precision ? sizeof(float) : sizeof(double);
}

/// Cell updates per second; time goes with the memory that is touched.
double throughput(const PlanRequest& r)
{
    return r.throughput > 0 ? r.throughput : kAssumedThroughput * D3Q19::Q / populations(r.lattice);
}

StepEstimate estimate(const PlanRequest& r, double dt)
{
    StepEstimate e;
    e.fluid_dt = dt;
    e.tau = relaxation_time(dt, r.dx, kinematic_viscosity(r));
    e.steps_per_fluid_step = dt / r.grain_dt;
    e.mach = kSqrt3 * r.speed * dt / r.dx;
    e.compressibility_error = e.mach * e.mach;
    e.static_compression = r.static_pressure * 3 * dt * dt / (r.density * r.dx * r.dx);
    e.motion_per_step = r.speed * dt / r.dx;
    e.contact_phase = r.contact_frequency * dt;
    if (std::isfinite(r.smallest_radius)) {
        e.shortest_transient = kSoundCrossingsToSettle * kSqrt3 * r.smallest_radius / r.dx * dt;
        e.transient_error =
            kErrorOfResolvedTransient * std::pow(e.shortest_transient / r.response_time, kTransientPower);
    }
    e.estimated_error = e.compressibility_error + e.static_compression + e.transient_error;
    e.cost = cell_count(r.cells) / throughput(r) / dt;
    return e;
}

StepEstimate of_grain_steps(const PlanRequest& r, double steps)
{
    StepEstimate e = estimate(r, steps >= 1 ? steps * r.grain_dt : r.grain_dt / std::round(1 / steps));
    e.steps_per_fluid_step = steps;
    return e;
}

/// The steps that the limits leave open.
struct Range {
    double shortest, longest;
    double accurate;  ///< longest with an error within the accuracy; may be shorter than the shortest
};

Range step_range(const PlanRequest& r)
{
    const double nu = kinematic_viscosity(r);
    Range range{fluid_time_step(kMinPlannedTau, r.dx, nu), fluid_time_step(kMaxPlannedTau, r.dx, nu), 0};
    if (r.speed == 0) range.longest = fluid_time_step(kMaxTauWithoutSpeed, r.dx, nu);
    if (r.speed > 0) range.longest = std::min(range.longest, r.max_mach * r.dx / (kSqrt3 * r.speed));
    if (r.static_pressure > 0)
        range.longest =
            std::min(range.longest, r.dx * std::sqrt(kMaxStaticCompression * r.density / (3 * r.static_pressure)));
    range.accurate = range.longest;
    if (estimate(r, range.longest).estimated_error <= r.accuracy) return range;
    // every part of the error grows with the step
    double low = 0, high = range.longest;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (estimate(r, middle).estimated_error > r.accuracy ? high : low) = middle;
    }
    range.accurate = low;
    return range;
}

/// Refuses if even the shortest step is too long.
void require_room(const PlanRequest& r, const Range& range)
{
    if (range.shortest <= range.longest * (1 + kHair)) return;
    const StepEstimate e = estimate(r, range.shortest);
    if (e.mach > r.max_mach)
        throw ConfigError(message("Mach number ", e.mach, " at the expected speed of ", r.speed,
                                  " m/s even with the smallest tau, ", kMinPlannedTau, ": above the limit ", r.max_mach,
                                  "; use dx <= ", r.dx * r.max_mach / e.mach, " m, or raise maxMach"));
    throw ConfigError(message("a static pressure of ", r.static_pressure, " Pa would compress the lattice's fluid by ",
                              100 * e.static_compression, " % even with the smallest tau, ", kMinPlannedTau,
                              ": above the limit ", 100 * kMaxStaticCompression,
                              " %; use dx <= ", r.dx * std::sqrt(kMaxStaticCompression / e.static_compression),
                              " m, or a less tall suspension"));
}

bool one_to_one(const StepEstimate& e) { return e.steps_per_fluid_step == 1; }

/// The ranking that the header states.
bool is_better(const PlanRequest& r, const StepEstimate& a, const StepEstimate& b)
{
    const bool a_fits = a.estimated_error <= r.accuracy, b_fits = b.estimated_error <= r.accuracy;
    if (a_fits != b_fits) return a_fits;
    if (!a_fits)
        return a.estimated_error < b.estimated_error || (a.estimated_error == b.estimated_error && a.cost < b.cost);
    if (one_to_one(a) != one_to_one(b)) return one_to_one(a);
    return a.cost < b.cost;
}

/// Every whole number up to 20 and, from there on, in steps of a tenth, `last` included.
std::vector<double> whole_numbers(double first, double last)
{
    std::vector<double> all;
    for (double n = first; n < last; n = n < 20 ? n + 1 : std::floor(1.1 * n)) all.push_back(n);
    if (first <= last) all.push_back(last);
    return all;
}

/// What the limits leave open, best first.
std::vector<StepEstimate> ranked(const PlanRequest& r, const Range& range)
{
    std::vector<StepEstimate> all;
    const auto most = [&](double dt) { return std::floor(dt / r.grain_dt * (1 + kHair)); };
    const double fewest = std::max(1.0, std::ceil(range.shortest / r.grain_dt * (1 - kHair)));
    for (const double n : whole_numbers(fewest, most(range.longest))) all.push_back(of_grain_steps(r, n));
    if (const double n = most(range.accurate); n >= fewest) all.push_back(of_grain_steps(r, n));

    const auto fewest_parts = [&](double dt) { return std::max(2.0, std::ceil(r.grain_dt / dt * (1 - kHair))); };
    const double most_parts =
        std::min<double>(kMaxFluidStepsPerGrainStep, std::floor(r.grain_dt / range.shortest * (1 + kHair)));
    for (const double n : whole_numbers(fewest_parts(range.longest), most_parts))
        all.push_back(of_grain_steps(r, 1 / n));
    if (const double n = fewest_parts(range.accurate); n <= most_parts) all.push_back(of_grain_steps(r, 1 / n));

    if (all.empty()) all.push_back(estimate(r, std::max(range.shortest, range.accurate)));
    std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return is_better(r, a, b); });
    all.erase(
        std::unique(all.begin(), all.end(),
                    [](const auto& a, const auto& b) { return a.steps_per_fluid_step == b.steps_per_fluid_step; }),
        all.end());
    return all;
}

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

/// With the ghosts around the box.
double lattice_bytes(const PlanRequest& r)
{
    const auto bytes = bytes_per_population(r.storage);
    const auto layout_slots = [&](auto lattice) {
        return double(Layout<decltype(lattice)>(r.cells, static_cast<std::size_t>(bytes)).slots);
    };
    return bytes * (r.lattice == Lattice::d3q27 ? layout_slots(D3Q27{}) : layout_slots(D3Q19{}));
}

/// What the same run would take with tau = 1, the usual choice, over what it takes now.
double work_at_tau_one(const PlanRequest& r, const StepEstimate& now)
{
    const double dt = fluid_time_step(1, r.dx, kinematic_viscosity(r));
    const double mach = kSqrt3 * r.speed * dt / r.dx;
    // Where that goes beyond the Mach number it takes a smaller dx, dt goes with dx^2 and the number of cells with dx^-3.
    const double finer = std::max(1.0, mach / r.max_mach);
    return now.fluid_dt / dt * std::pow(finer, 5);
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
    if (p.tau > 1 && p.cells_per_diameter > 0)
        all.push_back(message("tau = ", p.tau, ": steady loads do not depend on it, but transients shorter than ",
                              p.shortest_transient, " s are not resolved"));
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
    if (p.contact_phase > kWantedContactPhase)
        all.push_back(message(
            "contacts ring with up to ", r.contact_frequency, " rad/s, ", p.contact_phase,
            " times the inverse fluid step: above ", kWantedContactPhase,
            " the liquid hardly damps them; use a contact law with damping of its own, softer grains, or tau <= ",
            0.5 + (p.tau - 0.5) * kWantedContactPhase / p.contact_phase));
    return all;
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

void check(const PlanRequest& r, bool has_grain_dt)
{
    require_positive("dx", r.dx, "m");
    require_countable(r.cells);
    require_positive("density", r.density, "kg/m3");
    require_positive("viscosity", r.viscosity, "Pa s");
    if (has_grain_dt) require_positive("time step of the grains", r.grain_dt, "s");
    require_positive("maxMach", r.max_mach, "-");
    require_positive("accuracy", r.accuracy, "-");
    for (const auto& [name, value, unit] : {std::tuple{"speed", r.speed, "m/s"},
                                            {"static_pressure", r.static_pressure, "Pa"},
                                            {"contact_frequency", r.contact_frequency, "rad/s"},
                                            {"throughput", r.throughput, "cells/s"}})
        if (!(std::isfinite(value) && value >= 0))
            throw ConfigError(message(name, " = ", value, ": must be finite and >= 0 [", unit, "]"));
    if (!(r.response_time > 0)) throw ConfigError(message("response_time = ", r.response_time, ": must be > 0 [s]"));
}

StepEstimate given_step(const PlanRequest& r)
{
    if (!(r.tau >= kMinTau && r.tau <= kMaxTau))
        throw ConfigError(message("tau = ", r.tau, ": must lie between ", kMinTau, " and ", kMaxTau,
                                  "; leave it out to have it chosen from the time step of the grains"));
    StepEstimate e = estimate(r, fluid_time_step(r.tau, r.dx, kinematic_viscosity(r)));
    e.tau = r.tau;
    const auto largest_tau = [&](double part) { return 0.5 + (r.tau - 0.5) * part; };
    if (e.mach > r.max_mach)
        throw ConfigError(message("Mach number ", e.mach, " at the expected speed of ", r.speed,
                                  " m/s with tau = ", r.tau, ": above the limit ", r.max_mach,
                                  "; use tau <= ", largest_tau(r.max_mach / e.mach), " or a smaller dx"));
    if (e.static_compression > kMaxStaticCompression)
        throw ConfigError(message(
            "a static pressure of ", r.static_pressure, " Pa would compress the lattice's fluid by ",
            100 * e.static_compression, " % with tau = ", r.tau, ": above the limit ", 100 * kMaxStaticCompression,
            " %; use tau <= ", largest_tau(std::sqrt(kMaxStaticCompression / e.static_compression)),
            " or a smaller dx"));
    return e;
}

/// A request for cells of this size; the box becomes as many as it takes.
PlanRequest with_dx(PlanRequest r, const Vec3& lengths, double dx)
{
    r.dx = dx;
    for (int d = 0; d < 3; ++d) {
        const double n = std::max(1.0, std::round(lengths[d] / dx));
        r.cells[d] = static_cast<int>(std::min(n, 1e9));
    }
    return r;
}

struct Need {
    double memory_bytes, cost;
};

Need need(const PlanRequest& r)
{
    const Range range = step_range(r);
    // without a layout: too many cells for an address must not be an error here
    const double bytes = cell_count(r.cells) * populations(r.lattice) * bytes_per_population(r.storage);
    return {bytes, estimate(r, std::max(range.shortest, range.accurate)).cost};
}

/// The largest size up to dx with which all edges are whole numbers of cells.
double dividing(const Vec3& lengths, double dx)
{
    const double shortest = *std::min_element(lengths.begin(), lengths.end());
    const double first = std::max(1.0, std::ceil(shortest / dx * (1 - kHair)));
    for (double n = first; n <= 2 * first + 20; ++n) {
        const auto whole = [&](double length) {
            const double cells = length * n / shortest;
            return std::abs(cells - std::round(cells)) < 1e-6 * cells;
        };
        if (std::all_of(lengths.begin(), lengths.end(), whole)) return shortest / n;
    }
    throw ConfigError(message("no cell size near ", dx, " m divides the box of ", lengths[0], " x ", lengths[1], " x ",
                              lengths[2], " m; make it ", dx * std::ceil(lengths[0] / dx), " x ",
                              dx * std::ceil(lengths[1] / dx), " x ", dx * std::ceil(lengths[2] / dx),
                              " m for dx = ", dx));
}

}  // namespace

Plan plan_time_step(const PlanRequest& r)
{
    check(r, true);
    Plan p;
    std::string why = r.why_tau;
    const Range range = step_range(r);
    if (std::isnan(r.tau)) {
        require_room(r, range);
        p.ranking = ranked(r, range);
        why = why_first(r, p.ranking.front());
    } else {
        const StepEstimate given = given_step(r);
        if (range.shortest <= range.longest) p.ranking = ranked(r, range);
        p.ranking.insert(p.ranking.begin(), given);
    }
    static_cast<StepEstimate&>(p) = p.ranking.front();
    const double nu = kinematic_viscosity(r);
    const double longest_edge = r.dx * *std::max_element(r.cells.begin(), r.cells.end());
    double scale = 0.5 * longest_edge;
    if (std::isfinite(r.smallest_radius)) {
        scale = r.smallest_radius;
        p.reynolds = r.speed * r.mean_diameter / nu;
        p.cells_per_diameter = 2 * r.smallest_radius / r.dx;
    }
    p.viscous_time = scale * scale / nu;
    p.acoustic_time = kSqrt3 * longest_edge / r.dx * p.fluid_dt;
    p.memory_bytes = lattice_bytes(r);
    p.warnings = warnings(r, p);
    p.report = report(r, p, why);
    return p;
}

double resolution_error(double cells_per_diameter, double reynolds, double solid_fraction)
{
    double error = 0.17 + 0.09 * reynolds;
    if (solid_fraction > 0) {
        const double gap = std::cbrt(kPi / 6 / std::min(solid_fraction, 0.4)) - 1;
        error += 0.07 / (gap * gap);
    }
    return error / (cells_per_diameter * cells_per_diameter);
}

double suggest_dx(const PlanRequest& request, const Vec3& lengths, double solid_fraction, const Budget& budget)
{
    for (const double length : lengths) require_positive("length of the box", length, "m");
    require_positive("smallest radius", request.smallest_radius, "m");
    PlanRequest start = with_dx(request, lengths, request.smallest_radius);
    start.grain_dt = 1;  // of no consequence
    check(start, false);
    if (!(solid_fraction >= 0 && solid_fraction < 1))
        throw ConfigError(message("solid fraction = ", solid_fraction, ": must be >= 0 and < 1"));
    const double diameter = 2 * request.smallest_radius;
    const double reynolds = request.speed * request.mean_diameter / kinematic_viscosity(request);
    const auto error = [&](double dx) { return resolution_error(diameter / dx, reynolds, solid_fraction); };
    const double accurate = diameter / std::max(kWantedCellsPerDiameter, std::sqrt(error(diameter) / request.accuracy));
    const double dx = dividing(lengths, accurate);
    const PlanRequest r = with_dx(start, lengths, dx);
    const auto fits = [&](double size) {
        const Need n = need(with_dx(r, lengths, size));
        return n.memory_bytes <= budget.memory_bytes && n.cost <= budget.cost;
    };
    if (fits(dx)) return dx;
    const Need wanted = need(r);
    double low = dx, high = *std::max_element(lengths.begin(), lengths.end());
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? high : low) = middle;
    }
    throw ConfigError(message("accuracy = ", request.accuracy, " takes dx = ", dx, " m, ", wanted.memory_bytes / 1e9,
                              " GB and ", wanted.cost, " s per simulated second: beyond the budget of ",
                              budget.memory_bytes / 1e9, " GB and ", budget.cost, " s; it allows dx = ", high, " m, ",
                              diameter / high, " cells per diameter (at least ", kWantedCellsPerDiameter,
                              " are wanted) and accuracy = ", error(high)));
}

double suggest_dt(const PlanRequest& request, double largest, const Budget& budget)
{
    require_positive("largest time step of the grains", largest, "s");
    PlanRequest r = request;
    r.grain_dt = largest;
    check(r, true);
    const Range range = step_range(r);
    require_room(r, range);
    const double fluid_dt = std::max(range.shortest, range.accurate);
    if (const StepEstimate e = estimate(r, fluid_dt); e.cost > budget.cost)
        throw ConfigError(message("the longest fluid step within the accuracy of ", r.accuracy, ", ", fluid_dt,
                                  " s, costs ", e.cost, " s per simulated second: beyond the budget of ", budget.cost,
                                  " s; use dx >= ",
                                  // cells go with dx^-3, the step with dx to dx^2: the safe one
                                  r.dx * std::pow(e.cost / budget.cost, 0.25), " m, or a larger accuracy"));
    return fluid_dt / std::ceil(fluid_dt / largest * (1 - kHair));
}

}  // namespace lbm
