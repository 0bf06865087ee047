#pragma once

#include <core/Body.hpp>

#include <vector>

namespace yade {

class BodyContainer : public Serializable {
public:
    std::vector<shared_ptr<Body>> body;
    alignas(8) char opaque_[152];

    virtual ~BodyContainer();
    std::string getClassName() const override;
    Body::id_t insert(shared_ptr<Body> b);
};

}  // namespace yade
