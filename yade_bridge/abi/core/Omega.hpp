#pragma once

#include <lib/base/Math.hpp>
#include <lib/base/Singleton.hpp>

namespace yade {

class Scene;

class Omega : public Singleton<Omega> {
public:
    const shared_ptr<Scene>& getScene() const;
};

}  // namespace yade
