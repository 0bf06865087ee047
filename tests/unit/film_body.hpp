#pragma once

#include "physics/lubrication.hpp"

#include <limits>

namespace lbm::test {

/// One whose motion is prescribed has infinite mass and moment of inertia.
inline FilmBody moving(const Vec3& velocity, const Vec3& angular_velocity,
                       double mass = std::numeric_limits<double>::infinity(),
                       double inertia = std::numeric_limits<double>::infinity())
{
    return {velocity, angular_velocity, 1 / mass, 1 / inertia};
}

}  // namespace lbm::test
