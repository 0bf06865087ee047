#pragma once

#include "lbm/fluid_config.hpp"

#include "lbm/errors.hpp"

#include <limits>
#include <string>
#include <vector>

namespace lbm {

inline constexpr double kMinPlannedTau = 0.52;  ///< smallest tau at which free grains were shown stable
inline constexpr double kMaxPlannedTau = 2.0;   ///< largest tau that is chosen without being asked for

/// Cell updates per second where nothing was measured: a suspension in double precision on two cores (docs/performance.md).
inline constexpr double kAssumedThroughput = 1e8;

/// What is known before a run, from which the time step of the fluid follows. SI units; pure numbers, no state.
struct PlanRequest {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

    std::array<int, 3> cells{};
    double dx = 0;                          ///< [m]
    double density = 0;                     ///< of the fluid [kg/m3]
    double viscosity = 0;                   ///< dynamic [Pa s]
    double grain_dt = 0;                    ///< time step of the grains [s]
    double tau = kNaN;                      ///< NaN: to be chosen
    const char* why_tau = "tau was given";  ///< for the report, where tau is not NaN
    double max_mach = 0.2;                  ///< limit for the Mach number at `speed`
    double accuracy = 0.02;                 ///< estimated error that a chosen step may have [-], > 0
    double speed = 0;                       ///< largest speed expected of fluid, walls or grains [m/s]
    double smallest_radius = kInfinity;     ///< of the solids [m]
    double mean_diameter = 0;               ///< for the Reynolds number [m]; 0: no solids
    double response_time =
        kInfinity;  ///< in which the quickest free grain takes up its speed [s]; infinite: none is free
    double static_pressure =
        0;  ///< largest that the lattice has to carry at rest: submerged weight over area, drive times length [Pa]
    double contact_frequency = 0;  ///< of the stiffest contact, sqrt(k / m) [rad/s]; 0: not known
    double throughput = 0;         ///< measured [cell updates/s]; 0: kAssumedThroughput
    Lattice lattice = Lattice::d3q19;
    Storage storage = Storage::double_precision;
};

/**
 * A time step of the fluid and what is to be expected of it.
 *
 * The estimated error is the sum of three (docs/physics.md, "Which time step"): Ma^2, the relative density change by the
 * static pressure, and 1 % (shortest_transient / response_time)^1.3 for grains that lag behind their load. Each
 * grows with the step; steady loads in Stokes flow have none of them.
 */
struct StepEstimate {
    double tau = 0;
    double fluid_dt = 0;  ///< [s]
    double steps_per_fluid_step =
        0;            ///< grain steps in one fluid step; whole, or one over a whole number, where that fits
    double mach = 0;  ///< at the expected speed
    double compressibility_error = 0;  ///< Ma^2, relative density change by the flow
    double static_compression = 0;     ///< relative density change by the static pressure
    double shortest_transient = 0;     ///< times above this are resolved to about 1 % [s]; 0 without solids
    double transient_error = 0;        ///< of motion within the grains' response time
    double motion_per_step = 0;        ///< of a surface at the expected speed [cells per fluid step]
    double contact_phase = 0;          ///< contact frequency times fluid step; 0: not known
    double estimated_error = 0;        ///< sum of the three
    double cost = 0;                   ///< wall-clock seconds per simulated second
};

/// A grain step with more is refused: shorter grain steps cost nothing beside so many, and nobody waits unawares.
inline constexpr double kMaxFluidStepsPerGrainStep = 1e4;

/// A time step for the fluid that fits the grains' own, and what it means.
struct Plan : StepEstimate {
    double reynolds = 0;            ///< of a grain of mean diameter at the expected speed; 0 without solids
    double cells_per_diameter = 0;  ///< of the smallest solid; 0 without solids
    double viscous_time = 0;        ///< R^2 / nu of the smallest solid, of half the longest edge without one [s]
    double acoustic_time = 0;       ///< for sound on the lattice along the longest edge [s]
    double memory_bytes = 0;
    std::vector<StepEstimate>
        ranking;  ///< what was compared, best first; a given tau stands first whatever it is worth
    std::vector<std::string> warnings;  ///< what may go wrong, each a sentence
    std::string report;                 ///< the above as text, with why this set was chosen
};

/**
 * Chooses (tau = NaN) or checks (tau given) the fluid's time step dt = (tau - 1/2) dx^2 / (3 nu).
 *
 * Compared are whole numbers of grain steps and whole fractions of one, with tau from kMinPlannedTau to kMaxPlannedTau (to 1 where the
 * expected speed is 0, so not known) and a Mach number within its limit. Their ranking:
 *
 *     1. one fluid step per grain step, if its estimated error is within `accuracy`
 *     2. others within `accuracy`, the cheapest first
 *     3. the rest, the smallest error first
 *
 * Where no such number meets the limits: the longest step that does, whose ratio to the grain step is not whole.
 * @throws ConfigError  if a value is out of range, or no step meets the limits: the message names the limit and what would meet it
 */
Plan plan_time_step(const PlanRequest& request);

/// What a run may take; both > 0.
struct Budget {
    double memory_bytes = PlanRequest::kInfinity;
    double cost = PlanRequest::kInfinity;  ///< wall-clock seconds per simulated second
};

/**
 * Error of the drag of a sphere that is `cells_per_diameter` cells wide, as measured (docs/physics.md, "Which cell size") [-]:
 *
 *     (0.17 + 0.09 Re + 0.9 min(1, c / 0.3)^3) / cells_per_diameter^2
 *
 * with the solid fraction c; measured up to 0.6.
 */
double resolution_error(double cells_per_diameter, double reynolds, double solid_fraction);

/**
 * The largest cell size with which the drag of the smallest solid is within `request.accuracy`, at least 8 cells per
 * diameter, and the box a whole number of cells. Cells, dx, grain_dt and tau of the request are not used.
 * @param lengths         edges of the box [m]
 * @param solid_fraction  of the densest region [-], 0: lone solids
 * @throws ConfigError  if that exceeds the budget (the message says what would fit it), or no size divides the box
 */
double suggest_dx(const PlanRequest& request, const Vec3& lengths, double solid_fraction = 0,
                  const Budget& budget = {});

/**
 * The largest step of the grains, up to `largest`, for which the longest fluid step within `request.accuracy` and the limits is a whole
 * number of grain steps. grain_dt and tau of the request are not used.
 * @param largest  what the contacts allow [s], > 0
 * @throws ConfigError  if no step meets the limits, or the fluid costs more than the budget; the message says what would do
 */
double suggest_dt(const PlanRequest& request, double largest, const Budget& budget = {});

}  // namespace lbm
