#pragma once

#include "lbm/solid.hpp"

#include <cstdint>
#include <vector>

namespace yade {
class Scene;
}

namespace yadelbm {

/**
 * Impulses that the fluid gave and the grains have not received yet.
 *
 * A fluid step gives load * dt at once; the grains get it as a constant force over the grain steps until the next one.
 * What was given and what was received add up exactly, whatever happens to the steps on the way, so that the momentum of
 * fluid and grains is conserved at any ratio of the two.
 */
class HeldLoads {
public:
    /**
     * Adds the impulses of one fluid step. Bodies that are not among the solids any more take their rest with them.
     * @param solids  ascending ids
     * @param loads   in the order of the solids
     * @param dt      of the fluid step [s]
     */
    void add(const std::vector<lbm::Solid>& solids, const std::vector<lbm::SolidLoad>& loads, double dt);

    /// From now on everything left is delivered evenly over this time [s], > 0.
    void spread_over(double duration);

    /// Adds the current forces and torques to the scene's.
    void write(yade::Scene& scene) const;

    /// The grains were under the current forces for this long [s].
    void delivered(double elapsed) { delivered_ += elapsed; }

    struct Impulse {
        lbm::Vec3 linear{}, angular{};  // [N s], [N m s]
    };
    /// What a body has not received yet, counted when a fluid step was last added.
    Impulse owed(std::int64_t id) const;

    /// Sum of the linear impulses left after this much more time under the current forces [N s].
    lbm::Vec3 undelivered(double elapsed) const;

private:
    void settle();

    struct Held {
        std::int64_t id;
        lbm::Vec3 impulse, angular_impulse;  // left to deliver when the current forces began
        lbm::Vec3 force, torque;             // now on the grain
    };
    std::vector<Held> held_;     // ascending ids
    double delivered_ = 0;       // time under the current forces
    std::vector<Held> scratch_;  // to merge without allocating
};

}  // namespace yadelbm
