#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Shape : public Serializable, public Indexable {
public:
    alignas(8) char opaque_[32];
    Vector3r color;
    bool wire;
    bool highlight;

    virtual ~Shape();
    std::string getClassName() const override;
};

}  // namespace yade
