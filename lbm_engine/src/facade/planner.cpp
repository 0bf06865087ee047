#include "facade/planning.hpp"

#include "fields/populations.hpp"

#include <algorithm>

namespace lbm {
namespace planning {
namespace {

constexpr int kMaxRankedFluidSteps = 1000;  // per grain step

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

StepEstimate of_grain_steps(const PlanRequest& r, double steps)
{
    StepEstimate e = estimate(r, steps >= 1 ? steps * r.grain_dt : r.grain_dt / std::round(1 / steps));
    e.steps_per_fluid_step = steps;
    return e;
}

}  // namespace

double populations(Lattice lattice) { return lattice == Lattice::d3q27 ? D3Q27::Q : D3Q19::Q; }
double bytes_per_population(Storage storage)
{
    return storage == Storage::single_precision ? sizeof(float) : sizeof(double);
}

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

namespace {

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
        std::min<double>(kMaxRankedFluidSteps, std::floor(r.grain_dt / range.shortest * (1 + kHair)));
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

/// With the ghosts around the box.
double lattice_bytes(const PlanRequest& r)
{
    const auto bytes = bytes_per_population(r.storage);
    const auto layout_slots = [&](auto lattice) {
        return double(Layout<decltype(lattice)>(r.cells, static_cast<std::size_t>(bytes)).slots);
    };
    return bytes * (r.lattice == Lattice::d3q27 ? layout_slots(D3Q27{}) : layout_slots(D3Q19{}));
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

/// Fluid steps in a grain step; units that are mixed up make astronomical numbers of them.
void require_few(const PlanRequest& r, const StepEstimate& e)
{
    const double most = kMaxFluidStepsPerGrainStep * e.fluid_dt;
    if (r.grain_dt <= most * (1 + kHair)) return;
    throw ConfigError(message("time step of the grains = ", r.grain_dt, " s: holds ", r.grain_dt / e.fluid_dt,
                              " fluid steps of ", e.fluid_dt, " s (tau = ", e.tau, "), at most ",
                              kMaxFluidStepsPerGrainStep, " are possible; use one of at most ", most,
                              " s, or a larger dx"));
}

}  // namespace
}  // namespace planning

using namespace planning;

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
    require_few(r, p);
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

}  // namespace lbm
