#include "grains.hpp"

#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Sphere.hpp>

#include <algorithm>
#include <typeinfo>

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

lbm::Solid solid(const Body& body, double lead, const State& moving)
{
    const State& state = *body.state;
    lbm::Solid result;
    result.id = body.id;
    if (body.isClumpMember()) result.body = body.clumpId;
    if (const auto* box = dynamic_cast<const Box*>(body.shape.get())) {
        const yade::Quaternionr& q = state.se3.orientation;
        result.shape = lbm::Shape::box;
        result.half_extents = vec3(box->extents);
        result.orientation = {q.w(), q.x(), q.y(), q.z()};
    } else {
        result.radius = static_cast<const Sphere&>(*body.shape).radius;
    }
    result.position = vec3(state.se3.position);
    result.velocity = vec3(state.vel);
    result.angular_velocity = vec3(state.angVel);
    if (lead != 0)
        for (int d = 0; d < 3; ++d) result.position[d] += lead * result.velocity[d];
    // the bits of YADE's State: translations in the lower three, rotations in the next three
    constexpr unsigned kTranslations = 7, kRotations = 56;
    if ((moving.blockedDOFs & kTranslations) != kTranslations) result.mass = moving.mass;
    if ((moving.blockedDOFs & kRotations) != kRotations) result.inertia = moving.inertia.minCoeff();
    return result;
}

}  // namespace

void read_solids(const yade::Scene& scene, const Selection& selection, double lead, std::vector<lbm::Solid>& solids)
{
    const auto& bodies = scene.bodies->body;
    solids.clear();
    const auto take = [&](const yade::shared_ptr<Body>& body) {
        if (body && passes(*body, selection.mask)) solids.push_back(solid(*body, lead, moving_state(*body, bodies)));
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
