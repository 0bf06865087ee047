#pragma once

#include "settings.hpp"

#include "lbm/fluid_config.hpp"
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
 * @throws lbm::ConfigError  for a second engine or one in the wrong place, no sphere or box, a sphere that the lattice cannot hold, ids that are
 *         neither, a periodic cell that is not the fluid's box, a time step that is not finite and positive
 */
void check_scene(const yade::Scene& scene, const Settings& settings, const std::vector<lbm::Solid>& solids);

// Parts of `check_scene` that may break during a run.

/// @throws lbm::ConfigError  unless the scene has one fluid, listed once, before the integrator and, with lubrication, behind the contacts
void check_place(const yade::Scene& scene, const Settings& settings);
/// @throws lbm::ConfigError  unless the cell of a periodic scene is the fluid's box where that is periodic, and longer by more than a diameter elsewhere
void check_cell(const yade::Scene& scene, const Settings& settings, const std::vector<lbm::Solid>& solids);
/// @throws lbm::ConfigError  if an id of the settings is not among the solids, or there are none
void check_selection(const Settings& settings, const std::vector<lbm::Solid>& solids);

/**
 * What the planner wants to know of the scene as it is now; settings that are not set stay NaN. Contact stiffness and throughput
 * are left to those who know them.
 */
lbm::PlanRequest plan_request(const yade::Scene& scene, const Settings& settings,
                              const std::vector<lbm::Solid>& solids);

/// Name of the contact law of the scene that has lubrication of its own, or empty. Asks Python: the interpreter must be held.
std::string lubrication_law(const yade::Scene& scene);

/// @throws lbm::ConfigError  if fluid and contact law would both add lubrication
void check_lubrication(const Settings& settings, const std::string& law);

/**
 * What in the scene is likely not meant, each a sentence: no body in the fluid's box, bodies of a shape that the fluid does not see, clumps whose mass is not that of their volume, damping, another gravity, contacts that do not cross a periodic
 * face, a time stepper behind the fluid. Asks Python: the interpreter must be held.
 */
std::vector<std::string> scene_warnings(const yade::Scene& scene, const Settings& settings,
                                        const std::vector<lbm::Solid>& solids);

/// The same of this fluid and its solids: free bodies that are too light, spheres that overlap without being one clump.
std::vector<std::string> fluid_warnings(const lbm::FluidConfig& config, const std::vector<lbm::Solid>& solids);

/**
 * Frequency sqrt(k / m) of the stiffest contact [rad/s]: of those that there are, else of two equal spheres, from Young's moduli and radii
 * (k = young R, as Ip2_FrictMat_FrictMat_FrictPhys has it); 0 where neither is known or the scene has no InteractionLoop. Asks Python: the
 * interpreter must be held.
 */
double contact_frequency(const yade::Scene& scene, const std::vector<lbm::Solid>& solids);

/// The largest step that YADE deems stable for the contacts, utils.PWaveTimeStep() [s]; to be called from Python only.
double critical_time_step();

}  // namespace yadelbm
