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

class LbmEngine;

/**
 * Checks that a fluid with these settings fits the scene as it is now.
 * @param engine  whose settings they are; any other LbmEngine of the scene is an error
 * @throws lbm::ConfigError  for a second engine, no spheres, a sphere that the lattice cannot hold, ids that are no
 *         spheres, a periodic cell that is not the fluid's box, a time step that is not finite and positive
 */
void check_scene(const yade::Scene& scene, const Settings& settings, const LbmEngine& engine,
                 const std::vector<lbm::Solid>& solids);

/// The part of `check_scene` that may break during a run: the periodic cell against the fluid's box.
void check_cell(const yade::Scene& scene, const Settings& settings);

/**
 * A time step of the fluid for the scene as it is now.
 * @param tau  NaN: to be chosen
 * @throws lbm::ConfigError  if no step meets the limits
 */
lbm::Plan plan_for_scene(const yade::Scene& scene, const Settings& settings, const std::vector<lbm::Solid>& solids,
                         double tau);

/**
 * What in the scene is likely not meant, each a sentence: damping, another gravity, the order of engines, contacts that do
 * not cross a periodic face. Asks YADE's Python objects: to be called from Python only.
 */
std::vector<std::string> scene_warnings(const yade::Scene& scene, const Settings& settings, const LbmEngine& engine);

}  // namespace yadelbm
