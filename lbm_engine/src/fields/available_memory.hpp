#pragma once

#include <string>

namespace lbm {

/**
 * Memory that a program may still take before the system kills it [bytes]: what the machine has available, with free swap, and what the limits of its control
 * groups leave. Infinite where the system does not say (not Linux).
 * @param root  in front of /proc and /sys, for tests
 */
double available_memory(const std::string& root = "");

}  // namespace lbm
