#pragma once

#include <core/Shape.hpp>
#include <core/State.hpp>

namespace yade {

class Bound;
class Material;

class Body : public Serializable {
public:
    using id_t = int;
    static const id_t ID_NONE;

    id_t id;
    int groupMask;
    int flags;
    int subdomain;
    shared_ptr<Material> material;
    shared_ptr<State> state;
    shared_ptr<Shape> shape;
    shared_ptr<Bound> bound;
    alignas(8) char intrs_[48];
    int clumpId;
    long iterBorn;
    Real timeBorn;

    bool isClump() const { return clumpId != ID_NONE && id == clumpId; }
    bool isClumpMember() const { return clumpId != ID_NONE && id != clumpId; }

    Body();
    virtual ~Body();
    std::string getClassName() const override;
};

}  // namespace yade
