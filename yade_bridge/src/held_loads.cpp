#include "held_loads.hpp"

#include <core/Scene.hpp>

#include <algorithm>

namespace yadelbm {

/// What was delivered so far is taken off; once per change of the forces, not once per step.
void HeldLoads::settle()
{
    for (Held& held : held_)
        for (int d = 0; d < 3; ++d) {
            held.impulse[d] -= held.force[d] * delivered_;
            held.angular_impulse[d] -= held.torque[d] * delivered_;
        }
    delivered_ = 0;
}

void HeldLoads::add(const std::vector<lbm::Solid>& solids, const std::vector<lbm::SolidLoad>& loads, double dt)
{
    settle();
    scratch_.clear();
    auto old = held_.begin();
    for (std::size_t i = 0; i < solids.size(); ++i) {
        while (old != held_.end() && old->id < solids[i].id) ++old;
        const bool known = old != held_.end() && old->id == solids[i].id;
        Held held = known ? *old : Held{solids[i].id, {}, {}, {}, {}};
        for (int d = 0; d < 3; ++d) {
            held.impulse[d] += loads[i].force[d] * dt;
            held.angular_impulse[d] += loads[i].torque[d] * dt;
        }
        scratch_.push_back(held);
    }
    held_.swap(scratch_);
}

void HeldLoads::spread_over(double duration)
{
    settle();
    const double rate = 1 / duration;
    for (Held& held : held_)
        for (int d = 0; d < 3; ++d) {
            held.force[d] = held.impulse[d] * rate;
            held.torque[d] = held.angular_impulse[d] * rate;
        }
}

void HeldLoads::write(yade::Scene& scene) const
{
    const auto& bodies = scene.bodies->body;
    for (const Held& held : held_) {
        const auto index = static_cast<std::size_t>(held.id);
        if (index >= bodies.size() || !bodies[index]) continue;
        const auto id = static_cast<yade::Body::id_t>(held.id);
        scene.forces.addForce(id, yade::Vector3r(held.force[0], held.force[1], held.force[2]));
        scene.forces.addTorque(id, yade::Vector3r(held.torque[0], held.torque[1], held.torque[2]));
    }
}

HeldLoads::Impulse HeldLoads::owed(std::int64_t id) const
{
    const auto held =
        std::lower_bound(held_.begin(), held_.end(), id, [](const Held& h, std::int64_t i) { return h.id < i; });
    return held != held_.end() && held->id == id ? Impulse{held->impulse, held->angular_impulse} : Impulse{};
}

lbm::Vec3 HeldLoads::undelivered(double elapsed) const
{
    lbm::Vec3 sum{};
    for (const Held& held : held_)
        for (int d = 0; d < 3; ++d) sum[d] += held.impulse[d] - held.force[d] * (delivered_ + elapsed);
    return sum;
}

}  // namespace yadelbm
