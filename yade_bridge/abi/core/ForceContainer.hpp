#pragma once

#include <core/Body.hpp>

namespace yade {

/// Forces and torques of the current step; each OpenMP thread writes to a buffer of its own.
class ForceContainer {
    alignas(8) char opaque_[304];

public:
    ForceContainer();
    ~ForceContainer();
    void addForce(Body::id_t id, const Vector3r& f);
    void addTorque(Body::id_t id, const Vector3r& t);
    void sync();
    const Vector3r& getForce(Body::id_t id);
    const Vector3r& getTorque(Body::id_t id);
    const Vector3r getForceSingle(Body::id_t id);
    const Vector3r getTorqueSingle(Body::id_t id);
};

}  // namespace yade
