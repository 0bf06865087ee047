#pragma once

#include "lattice/vec3.hpp"
#include "physics/solid_fraction.hpp"

#include <cstdint>

namespace lbm {

/// A solid in lattice units.
struct LatticeSolid {
    SolidGeometry geometry;
    std::int64_t body = -1;
    Vec3 velocity{}, angular_velocity{};
    bool fixed = false;  ///< at rest, and not free to move
};

}  // namespace lbm
