#include "held_loads.hpp"

#include <core/Scene.hpp>

#include <algorithm>

namespace yadelbm {
namespace {

/// a += factor * b
void add_to(Impulse& a, double factor, const Impulse& b)
{
    for (int d = 0; d < 3; ++d) {
        a.linear[d] += factor * b.linear[d];
        a.angular[d] += factor * b.angular[d];
    }
}

}  // namespace

void HeldLoads::add(const std::vector<lbm::Solid>& solids, const std::vector<lbm::SolidLoad>& loads, double dt)
{
    scratch_.clear();
    auto old = held_.begin();
    for (std::size_t i = 0; i < solids.size(); ++i) {
        while (old != held_.end() && old->id < solids[i].id) ++old;
        const bool known = old != held_.end() && old->id == solids[i].id;
        Held held = known ? *old : Held{solids[i].id, {}, {}, {}};
        held.rate = {loads[i].force, loads[i].torque};
        add_to(held.left, dt, held.rate);
        scratch_.push_back(held);
    }
    held_.swap(scratch_);
}

void HeldLoads::hold_for(double grain_dt, double ahead, double fluid_dt)
{
    const double last = std::min(ahead, fluid_dt), before = ahead - last;
    const double share_before = before > grain_dt ? grain_dt / before : 1;
    const double last_now = std::clamp(grain_dt - before, 0.0, last);
    for (Held& held : held_) {
        held.now = {};
        add_to(held.now, share_before / grain_dt, held.left);
        add_to(held.now, (last_now - share_before * last) / grain_dt, held.rate);
    }
}

void HeldLoads::delivered(double elapsed)
{
    for (Held& held : held_) add_to(held.left, -elapsed, held.now);
}

void HeldLoads::write(yade::Scene& scene) const
{
    const auto& bodies = scene.bodies->body;
    for (const Held& held : held_) {
        const auto index = static_cast<std::size_t>(held.id);
        if (index >= bodies.size() || !bodies[index]) continue;
        const auto id = static_cast<yade::Body::id_t>(held.id);
        const auto& [force, torque] = held.now;
        scene.forces.addForce(id, yade::Vector3r(force[0], force[1], force[2]));
        scene.forces.addTorque(id, yade::Vector3r(torque[0], torque[1], torque[2]));
    }
}

const HeldLoads::Held* HeldLoads::find(std::int64_t id) const
{
    const auto held =
        std::lower_bound(held_.begin(), held_.end(), id, [](const Held& h, std::int64_t i) { return h.id < i; });
    return held != held_.end() && held->id == id ? &*held : nullptr;
}

Impulse HeldLoads::owed(std::int64_t id) const
{
    const Held* held = find(id);
    return held ? held->left : Impulse{};
}

Impulse HeldLoads::current(std::int64_t id) const
{
    const Held* held = find(id);
    return held ? held->now : Impulse{};
}

lbm::Vec3 HeldLoads::undelivered(double elapsed) const
{
    Impulse sum;
    for (const Held& held : held_) {
        add_to(sum, 1, held.left);
        add_to(sum, -elapsed, held.now);
    }
    return sum.linear;
}

}  // namespace yadelbm
