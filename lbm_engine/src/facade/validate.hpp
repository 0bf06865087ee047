#pragma once

#include "lbm/fluid_config.hpp"

#include <vector>

namespace lbm {

inline constexpr const char* kFaceNames[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};  ///< in messages

/// @throws ConfigError naming the first value outside its range
void validate(const FluidConfig& config);

/// @throws ConfigError naming the first solid that the box cannot hold
void validate(const FluidConfig& config, const std::vector<Solid>& solids);

/// @throws ConfigError naming an id that stands twice
void require_unique_ids(const std::vector<Solid>& solids);

}  // namespace lbm
