#pragma once

#include "settings.hpp"

#include "lbm/planner.hpp"
#include "lbm/solid.hpp"

#include <string>
#include <vector>

namespace yade {
class Scene;
}

namespace yadelbm {

/**
 * Checks that a fluid with these settings fits the scene as it is now.
 * @throws lbm::ConfigError  for a second engine or one behind the integrator, no spheres, a sphere that the lattice cannot hold, ids that are no
 *         spheres, a periodic cell that is not the fluid's box, a time step that is not finite and positive
 */
void check_scene(const yade::Scene& scene, const Settings& settings, const std::vector<lbm::Solid>& solids);

// Parts of `check_scene` that may break during a run.

/// @throws lbm::ConfigError  unless the scene has one fluid, listed once and before the integrator
void check_place(const yade::Scene& scene);
/// @throws lbm::ConfigError  unless the cell of a periodic scene is the fluid's box
void check_cell(const yade::Scene& scene, const Settings& settings);
/// @throws lbm::ConfigError  if an id of the settings is not among the solids, or there are none
void check_selection(const Settings& settings, const std::vector<lbm::Solid>& solids);

/**
 * A time step of the fluid for the scene as it is now.
 * @param tau      NaN: to be chosen
 * @param why_tau  for the report, where it is not
 * @throws lbm::ConfigError  if no step meets the limits
 */
lbm::Plan plan_for_scene(const yade::Scene& scene, const Settings& settings, const std::vector<lbm::Solid>& solids,
                         double tau, const char* why_tau = "tau was given");

/**
 * What in the scene is likely not meant, each a sentence: damping, another gravity, contacts that do not cross a periodic
 * face. Asks YADE's Python objects: to be called from Python only.
 */
std::vector<std::string> scene_warnings(const yade::Scene& scene, const Settings& settings);

}  // namespace yadelbm
