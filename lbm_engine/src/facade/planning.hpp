// What the parts of the planner share: the choice of a step (planner.cpp), the report on it (plan_report.cpp), suggestions (suggestions.cpp).
#pragma once

#include "lbm/planner.hpp"

#include "lattice/message.hpp"
#include "lattice/units.hpp"

#include <string>
#include <vector>

namespace lbm::planning {

inline constexpr double kSqrt3 = 1.7320508075688772;
inline constexpr double kHair = 1e-9;  // so that a step that gives exactly a limit meets it

/// Cells across a diameter below which drag errors of several per cent are to be expected.
inline constexpr double kWantedCellsPerDiameter = 8;
inline constexpr double kWantedResolutionError = 0.02;

inline double kinematic_viscosity(const PlanRequest& r) { return r.viscosity / r.density; }
inline double cell_count(const std::array<int, 3>& cells) { return double(cells[0]) * cells[1] * cells[2]; }
double populations(Lattice lattice);
double bytes_per_population(Storage storage);
/// Cell updates per second; time goes with the memory that is touched.
double throughput(const PlanRequest& r);

/// What a fluid step takes and may get wrong.
StepEstimate estimate(const PlanRequest& r, double dt);

/// The steps that the limits leave open.
struct Range {
    double shortest, longest;
    double accurate;  ///< longest with an error within the accuracy; may be shorter than the shortest
};
Range step_range(const PlanRequest& r);

/// Refuses if even the shortest step is too long.
void require_room(const PlanRequest& r, const Range& range);

/// Refuses what cannot be planned for.
void check(const PlanRequest& r, bool has_grain_dt);

std::string why_first(const PlanRequest& r, const StepEstimate& first);
std::vector<std::string> warnings(const PlanRequest& r, const Plan& p);
std::string report(const PlanRequest& r, const Plan& p, const std::string& why);

}  // namespace lbm::planning
