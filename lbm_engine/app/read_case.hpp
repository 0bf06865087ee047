#pragma once

#include "lbm/fluid.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace lbm {

/// A solid of a case: its motion is none, prescribed or free.
struct CaseSolid {
    Solid solid;
    bool moving = false;  ///< moves through the lattice at its velocity
    bool free = false;    ///< answers to its load; mass and moments of its body follow from the densities of the parts
    double density = 0;   ///< of a free one [kg/m3]
};

/// A run of the engine alone, as `lbm run CASE.json` describes it.
struct Case {
    FluidConfig fluid;
    std::vector<CaseSolid> solids;
    double steady = 0;  ///< stop when nothing changed by more than this fraction; 0: never
    std::int64_t max_steps = 100000;
    std::string vtk;  ///< path, or empty
};

/// @throws ConfigError naming the key that is unknown, missing or of the wrong type
Case read_case(const nlohmann::json& json);

}  // namespace lbm
