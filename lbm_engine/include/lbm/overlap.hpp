#pragma once

#include "lbm/fluid_config.hpp"
#include "lbm/solid.hpp"

#include <cstdint>
#include <vector>

namespace lbm {

/// Of the smaller sphere's volume, what contacts may take; more is worth a warning. Equal spheres share it at an overlap of 0.16 radii.
inline constexpr double kContactOverlap = 0.01;

/// Spheres that have more than a contact in common and are not parts of one body: what they share counts to both of them.
struct Overlaps {
    int pairs = 0;            ///< images of one pair count each
    std::int64_t one, other;  ///< ids of those that share most
    double shared = 0;        ///< by them, part of the smaller one's volume
};

/**
 * Looks for spheres in the fluid's box, and across its periodic faces, that overlap each other.
 * @param solids  as `Fluid::place_solids` takes them
 */
Overlaps overlaps(const FluidConfig& config, const std::vector<Solid>& solids);

/// Volume that spheres fill together [m3]; along 64 x 64 lines, within 1e-3 of it for those of similar size.
double union_volume(const std::vector<Solid>& spheres);

}  // namespace lbm
