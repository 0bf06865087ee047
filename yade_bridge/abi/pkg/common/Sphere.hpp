#pragma once

#include <core/Shape.hpp>

namespace yade {

class Sphere : public Shape {
public:
    Real radius;

    virtual ~Sphere();
    std::string getClassName() const override;
};

}  // namespace yade
