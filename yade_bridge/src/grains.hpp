#pragma once

#include "held_loads.hpp"

#include "lbm/solid.hpp"

#include <vector>

namespace yadelbm {

/// Which bodies of a scene are solids of the fluid: those with a Sphere shape that pass both conditions.
struct Selection {
    int mask = 0;                 ///< a body passes if it shares a bit; 0 or -1: all
    const std::vector<int>& ids;  ///< bodies to take; empty: all
};

/**
 * The selected spheres as solids, in ascending order of their ids.
 *
 * Members of clumps are parts of one rigid body, with the velocity that YADE gives them and the mass of the clump; clumps themselves have no shape. A body
 * that cannot answer to forces (blocked, or without mass) has infinite mass, likewise for rotation. Erased bodies, other
 * shapes and ids that do not exist are passed over.
 */
void read_solids(const yade::Scene& scene, const Selection& selection, std::vector<lbm::Solid>& solids);

/**
 * Brings the velocities of the solids to a later time, under the forces that stand in the scene now and the integrator's gravity, as if nothing else happened to them but
 * impulses that they are owed. Directions that are blocked keep their velocities; members of a clump move with it.
 * @param solids  as read_solids gave them
 * @param dt      how much later: at most the grain step that is about to be made [s]
 */
void foretell(yade::Scene& scene, double dt, std::vector<lbm::Solid>& solids, const HeldLoads& owed = {});

}  // namespace yadelbm
