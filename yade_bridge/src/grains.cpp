#include "grains.hpp"

#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

#include <algorithm>
#include <typeinfo>
#include <unordered_map>

namespace yadelbm {
namespace {

using yade::Body;
using yade::Box;
using yade::Sphere;
using yade::State;

lbm::Vec3 vec3(const yade::Vector3r& v) { return {v[0], v[1], v[2]}; }

bool passes(const Body& body, int mask)
{
    if (!body.shape || !body.state) return false;
    // exact types: derived shapes (nodes of beams and membranes) are parts of something else
    const yade::Shape& shape = *body.shape;
    return (mask == 0 || mask == -1 || (body.groupMask & mask) != 0) &&
           (typeid(shape) == typeid(Sphere) || typeid(shape) == typeid(Box));
}

/// What moves: the clump of a member, or the body itself.
const State& moving_state(const Body& body, const std::vector<yade::shared_ptr<Body>>& bodies)
{
    if (body.isClumpMember()) {
        const auto clump = static_cast<std::size_t>(body.clumpId);
        if (clump < bodies.size() && bodies[clump] && bodies[clump]->state) return *bodies[clump]->state;
    }
    return *body.state;
}

lbm::Solid solid(const Body& body, const State& moving)
{
    const State& state = *body.state;
    lbm::Solid result;
    result.id = body.id;
    if (body.isClumpMember()) {
        result.body = body.clumpId;
        result.lever = vec3(state.se3.position - moving.se3.position);
    }
    const yade::Shape& shape = *body.shape;
    if (typeid(shape) == typeid(Sphere)) {
        result.radius = static_cast<const Sphere&>(shape).radius;
    } else {
        const yade::Quaternionr& q = state.se3.orientation;
        result.shape = lbm::Shape::box;
        result.half_extents = vec3(static_cast<const Box&>(shape).extents);
        result.orientation = {q.w(), q.x(), q.y(), q.z()};
    }
    result.position = vec3(state.se3.position);
    result.velocity = vec3(state.vel);
    result.angular_velocity = vec3(state.angVel);
    // the bits of YADE's State: translations in the lower three, rotations in the next three
    constexpr unsigned kTranslations = 7, kRotations = 56;
    if ((moving.blockedDOFs & kTranslations) != kTranslations) result.mass = moving.mass;
    for (std::size_t d = 0; d < 3; ++d) result.held[d] = moving.blockedDOFs & (1u << d);
    if ((moving.blockedDOFs & kRotations) != kRotations) result.inertia = moving.inertia.minCoeff();
    return result;
}

yade::Vector3r vector3r(const lbm::Vec3& v) { return {v[0], v[1], v[2]}; }

/// Linear and angular.
struct ImpulseOnGrain {
    yade::Vector3r linear = yade::Vector3r::Zero(), angular = yade::Vector3r::Zero();
};

ImpulseOnGrain impulse_on(yade::Scene& scene, double dt, const HeldLoads& owed, Body::id_t id)
{
    const Impulse more = owed.owed(id);
    return {dt * scene.forces.getForce(id) + vector3r(more.linear),
            dt * scene.forces.getTorque(id) + vector3r(more.angular)};
}

/// What the clumps get themselves and through their members, solids of the fluid or not.
std::unordered_map<int, ImpulseOnGrain> impulses_on_clumps(yade::Scene& scene, double dt, const HeldLoads& owed)
{
    std::unordered_map<int, ImpulseOnGrain> impulses;
    const auto& bodies = scene.bodies->body;
    for (const auto& body : bodies) {
        if (!body || body->clumpId == Body::ID_NONE) continue;
        const ImpulseOnGrain on = impulse_on(scene, dt, owed, body->id);
        ImpulseOnGrain& sum = impulses[body->clumpId];
        const State& clump = moving_state(*body, bodies);
        sum.linear += on.linear;
        sum.angular += on.angular + (body->state->se3.position - clump.se3.position).cross(on.linear);
    }
    return impulses;
}

/// Null where nothing moves the grains.
const yade::NewtonIntegrator* integrator_of(const yade::Scene& scene)
{
    for (const auto& engine : scene.engines)
        if (engine && !engine->dead && engine->getClassName() == "NewtonIntegrator")
            return static_cast<const yade::NewtonIntegrator*>(engine.get());
    return nullptr;
}

/// Changes of velocity and spin.
struct Change {
    yade::Vector3r velocity, spin;
};

/// As NewtonIntegrator has it: a body of which anything is blocked is turned about the axes of space by its principal moments.
Change change_by(const ImpulseOnGrain& on, const State& state, const yade::Vector3r& fall)
{
    Change change{yade::Vector3r::Zero(), yade::Vector3r::Zero()};
    if (state.mass > 0) change.velocity = on.linear / state.mass + fall;
    if (state.inertia.minCoeff() > 0) {
        const yade::Quaternionr q = state.blockedDOFs ? yade::Quaternionr::Identity() : state.se3.orientation;
        change.spin = q * (q.conjugate() * on.angular).cwiseQuotient(state.inertia);
    }
    for (int d = 0; d < 3; ++d) {
        if (state.blockedDOFs & (1u << d)) change.velocity[d] = 0;
        if (state.blockedDOFs & (8u << d)) change.spin[d] = 0;
    }
    return change;
}

}  // namespace

void foretell(yade::Scene& scene, double dt, std::vector<lbm::Solid>& solids, const HeldLoads& owed)
{
    const yade::NewtonIntegrator* integrator = integrator_of(scene);
    if (!integrator) return;
    scene.forces.sync();
    const auto& bodies = scene.bodies->body;
    const yade::Vector3r fall = dt * integrator->gravity;
    const bool clumps = std::any_of(solids.begin(), solids.end(), [](const lbm::Solid& s) { return s.body >= 0; });
    const auto on_clumps = clumps ? impulses_on_clumps(scene, dt, owed) : std::unordered_map<int, ImpulseOnGrain>{};
    for (lbm::Solid& solid : solids) {
        const Body& body = *bodies[static_cast<std::size_t>(solid.id)];
        const bool member = body.isClumpMember();
        const ImpulseOnGrain on = member ? on_clumps.at(body.clumpId) : impulse_on(scene, dt, owed, body.id);
        const Change change = change_by(on, moving_state(body, bodies), fall);
        const yade::Vector3r at_centre = change.velocity + change.spin.cross(vector3r(solid.lever));
        for (int d = 0; d < 3; ++d) {
            solid.velocity[d] += at_centre[d];
            solid.angular_velocity[d] += change.spin[d];
        }
    }
}

void read_solids(const yade::Scene& scene, const Selection& selection, std::vector<lbm::Solid>& solids)
{
    const auto& bodies = scene.bodies->body;
    solids.clear();
    const auto take = [&](const yade::shared_ptr<Body>& body) {
        if (body && passes(*body, selection.mask)) solids.push_back(solid(*body, moving_state(*body, bodies)));
    };
    if (selection.ids.empty()) {
        solids.reserve(bodies.size());
        for (const auto& body : bodies) take(body);
        return;
    }
    std::vector<int> ids = selection.ids;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (int id : ids)
        if (id >= 0 && static_cast<std::size_t>(id) < bodies.size()) take(bodies[id]);
}

}  // namespace yadelbm
