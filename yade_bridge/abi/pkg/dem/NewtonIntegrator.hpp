#pragma once

#include <core/GlobalEngine.hpp>

namespace yade {

/// Its weight on the grains; never made here, and known by its class name.
class NewtonIntegrator : public GlobalEngine {
    alignas(8) char opaque_[152];

public:
    Real damping;
    Vector3r gravity;

    NewtonIntegrator() = delete;
};

}  // namespace yade
