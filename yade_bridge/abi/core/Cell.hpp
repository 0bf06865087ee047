#pragma once

#include <lib/serialization/Serializable.hpp>

namespace yade {

class Cell : public Serializable {
    alignas(8) char opaque1_[712];

public:
    Matrix3r hSize;
    Matrix3r prevHSize;
    Matrix3r velGrad;

private:
    alignas(8) char opaque2_[152];

public:
    virtual ~Cell();
    std::string getClassName() const override;
};

}  // namespace yade
