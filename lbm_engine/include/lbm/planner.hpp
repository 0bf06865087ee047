#pragma once

#include "lbm/fluid_config.hpp"

#include "lbm/errors.hpp"

#include <limits>
#include <string>
#include <vector>

namespace lbm {

/// What is known before a run, from which the time step of the fluid follows. SI units; pure numbers, no state.
struct PlanRequest {
    std::array<int, 3> cells{};
    double dx = 0;                                          ///< [m]
    double density = 0;                                     ///< of the fluid [kg/m3]
    double viscosity = 0;                                   ///< dynamic [Pa s]
    double grain_dt = 0;                                    ///< time step of the grains [s]
    double tau = std::numeric_limits<double>::quiet_NaN();  ///< NaN: to be chosen
    const char* why_tau = "tau was given";                  ///< for the report, where tau is not NaN
    double max_mach = 0.2;                                  ///< limit for the Mach number at `speed`
    double speed = 0;                                       ///< largest speed expected of fluid, walls or grains [m/s]
    double smallest_radius = std::numeric_limits<double>::infinity();  ///< of the solids [m]
    double mean_diameter = 0;                                          ///< for the Reynolds number [m]; 0: no solids
};

/// A time step for the fluid that fits the grains' own, and what it means.
struct Plan {
    double tau = 0;
    double fluid_dt = 0;  ///< [s]
    double steps_per_fluid_step =
        0;                ///< grain steps in one fluid step; whole, or one over a whole number, where that fits
    double mach = 0;      ///< at the expected speed
    double reynolds = 0;  ///< of a grain of mean diameter at that speed; 0 without solids
    double cells_per_diameter = 0;     ///< of the smallest solid; 0 without solids
    double motion_per_step = 0;        ///< of a surface at the expected speed [cells per fluid step]
    double compressibility_error = 0;  ///< Ma^2, relative density change at the expected speed
    double shortest_transient = 0;     ///< times above this are resolved to about 1 % [s]; 0 without solids
    double memory_bytes = 0;
    std::vector<std::string> warnings;  ///< what may go wrong, each a sentence
    std::string report;                 ///< the above as text, with why this set was chosen
};

/**
 * Chooses (tau = NaN) or checks (tau given) the fluid's time step dt = (tau - 1/2) dx^2 / (3 nu).
 *
 * Chosen: the smallest whole number of grain steps for which tau >= kMinPlannedTau; where one grain step is already too long
 * (tau > kMaxPlannedTau, or the Mach number beyond its limit), a whole fraction of it; where
 * neither meets the limits, the longest step that does, whose ratio to the grain step is not whole.
 * @throws ConfigError  if a value is out of range, or no step meets the limits: the message names the limit and what would meet it
 */
Plan plan_time_step(const PlanRequest& request);

inline constexpr double kMinPlannedTau = 0.52;  ///< smallest tau at which free grains were shown stable
inline constexpr double kMaxPlannedTau = 2.0;   ///< largest tau that is chosen without being asked for

}  // namespace lbm
