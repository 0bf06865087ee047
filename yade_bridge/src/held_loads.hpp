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
     * Forces for the grain step that begins now: what is left of the last fluid step as its load over the time that it covers, what is left of those
     * before (a grain step was cut short) evenly until then.
     * @param grain_dt  of that grain step [s]
     * @param ahead     from its beginning to the end of the last fluid step [s]
     * @param fluid_dt  of the last fluid step [s]
     */
    void hold_for(double grain_dt, double ahead, double fluid_dt);

    /// Adds the current forces and torques to the scene's.
    void write(yade::Scene& scene) const;

    /// The grains were under the current forces for this long [s].
    void delivered(double elapsed);

    /// What a body has not received yet.
    Impulse owed(std::int64_t id) const;
    /// Force and torque now on a body [N, N m].
    Impulse current(std::int64_t id) const;

    /// Sum of the linear impulses left after this much more time under the current forces [N s].
    lbm::Vec3 undelivered(double elapsed) const;

private:
    struct Held;
    const Held* find(std::int64_t id) const;

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
