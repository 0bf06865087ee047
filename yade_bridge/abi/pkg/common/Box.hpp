#pragma once

#include <core/Shape.hpp>

namespace yade {

class Box : public Shape {
public:
    Vector3r extents;  ///< half sizes

    virtual ~Box();
    std::string getClassName() const override;
};

}  // namespace yade
