#pragma once

#include "physics/solid_fraction.hpp"

namespace lbm {

/**
 * Volume that a cell shares with a box at any angle: exact but for round-off.
 * @param cell  its lowest corner
 */
[[nodiscard]] double box_fraction(const SolidGeometry& box, const Vec3& cell);

}  // namespace lbm
