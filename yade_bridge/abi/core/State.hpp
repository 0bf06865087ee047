#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class State : public Serializable, public Indexable {
public:
    Vector3r& pos;
    Quaternionr& ori;
    alignas(8) char updateMutex_[40];
    enum { DOF_NONE = 0, DOF_X = 1, DOF_Y = 2, DOF_Z = 4, DOF_RX = 8, DOF_RY = 16, DOF_RZ = 32 };
    static const unsigned DOF_ALL = DOF_X | DOF_Y | DOF_Z | DOF_RX | DOF_RY | DOF_RZ;
    static const unsigned DOF_XYZ = DOF_X | DOF_Y | DOF_Z;
    static const unsigned DOF_RXRYRZ = DOF_RX | DOF_RY | DOF_RZ;
    Se3r se3;
    Vector3r vel;
    Real mass;
    Vector3r angVel;
    Vector3r angMom;
    Vector3r inertia;
    Vector3r refPos;
    Quaternionr refOri;
    unsigned blockedDOFs;
    bool isDamped;
    Real densityScaling;

    State();
    virtual ~State();
    std::string getClassName() const override;
};

}  // namespace yade
