#pragma once

#include "lbm/solid.hpp"

#include <cstdint>
#include <vector>

namespace yade {
class Scene;
}

namespace yadelbm {

/// What changes the velocity and the spin of a body.
struct Impulse {
    lbm::Vec3 linear{}, angular{};  // [N s], [N m s]
};

/**
 * Impulses that the fluid gave and the grains have not received yet.
 *
 * A fluid step gives load * dt at once; the grains get it as a constant force over just the time that the fluid step covers, also where
 * that is no whole number of their steps: in each they get the mean of the loads over it.
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

    /**
     * The forces of the grain step that begins now deliver all that is left, but for the share of the last fluid step that lies beyond it.
     * @param grain_dt  of that grain step [s]
     * @param beyond    how far the last fluid step reaches beyond the end of that grain step, >= 0 [s]
     */
    void hold_for(double grain_dt, double beyond);

    /// Adds the current forces and torques to the scene's.
    void write(yade::Scene& scene) const;

    /// The grains were under the current forces for this long [s].
    void delivered(double elapsed);

    /// What a body has not received yet.
    Impulse owed(std::int64_t id) const;

    /// Sum of the linear impulses left after this much more time under the current forces [N s].
    lbm::Vec3 undelivered(double elapsed) const;

private:
    struct Held {
        std::int64_t id;
        Impulse left;
        Impulse rate;  // of the last fluid step, per time: its load
        Impulse now;   // on the grain, per time
    };
    std::vector<Held> held_;     // ascending ids
    std::vector<Held> scratch_;  // to merge without allocating
};

}  // namespace yadelbm
