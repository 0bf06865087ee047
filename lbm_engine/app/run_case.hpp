#pragma once

#include "read_case.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace lbm {

/// How far a run is, for those who wait for it.
struct Progress {
    std::int64_t step, max_steps;
    double seconds;
    double change;  ///< largest relative change over the last window; infinity before the first
};

struct CaseResult {
    nlohmann::json json;
    bool converged;
    std::string not_written;  ///< why there is no file for ParaView; empty: there is, or none was asked for
};

/**
 * Runs a case until it is steady or its steps are used up.
 *
 * Steady: the mean velocity and every load changed by less than the fraction `steady` of their size over one tenth of the slowest viscous
 * time, L^2 / (pi^2 nu) for the longest side L (at least 200 steps).
 * @param warn  is given what is likely not meant, before the first step
 * @throws ConfigError, RunError
 */
CaseResult run_case(const Case& input, const std::function<void(const Progress&)>& report,
                    const std::function<void(const std::string&)>& warn);

}  // namespace lbm
