#pragma once

#include "settings.hpp"

#include "lbm/solid.hpp"

#include <vector>

namespace yadelbm {

/**
 * Terminal speed of a sphere that is `density_difference` heavier (or lighter) than the fluid [m/s].
 *
 *     C_d = 24/Re (1 + 0.15 Re^0.687)      up to Re = 1000, 0.44 above
 *
 * @see Schiller & Naumann (1933), Z. Ver. Deutsch. Ing. 77, 318
 */
double settling_speed(double diameter, double density_difference, double gravity, double density, double viscosity);

/// Largest speed to expect in a run that starts from here [m/s]: of grains, walls, settling and the flow under the drive.
double expected_speed(const Settings& settings, const std::vector<lbm::Solid>& solids);

/**
 * Time in which the quickest free sphere takes up the speed that its load gives it [s]: with the added mass, at the speed `speed`;
 * infinite if none is free.
 *
 *     (rho_p / rho_f + 1/2) (2/9) R^2 / nu / (1 + 0.15 Re^0.687)
 */
double response_time(const Settings& settings, const std::vector<lbm::Solid>& solids, double speed);

/**
 * Largest pressure that the lattice has to carry in a fluid at rest [Pa]: the largest of the pressure faces, between walls the submerged weight of the free spheres over the
 * area, and the drive over the box; the drive over a mean diameter where it is periodic.
 */
double static_pressure(const Settings& settings, const std::vector<lbm::Solid>& solids);

}  // namespace yadelbm
