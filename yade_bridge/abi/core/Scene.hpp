#pragma once

#include <core/Body.hpp>
#include <core/BodyContainer.hpp>
#include <core/Cell.hpp>
#include <core/Engine.hpp>
#include <core/ForceContainer.hpp>

namespace yade {

class Scene : public Serializable {
    const unsigned int hostNameMax = 255;

public:
    ForceContainer forces;
    Eigen::Matrix<Real, 10, 1> SpeedElements;
    shared_ptr<void> renderer;
    alignas(8) char prevTime_[8];
    Real dt;
    long iter;
    bool subStepping;
    int subStep;
    Real time;
    Real speed;
    long stopAtIter;
    Real stopAtTime;
    bool isPeriodic;
    bool trackEnergy;
    bool doSort;
    bool runInternalConsistencyChecks;
    Body::id_t selectedBody;
    int subdomain;
    shared_ptr<Shape> subD;
    std::vector<std::string> tags;
    std::vector<shared_ptr<Engine>> engines;
    std::vector<shared_ptr<Engine>> _nextEngines;
    shared_ptr<BodyContainer> bodies;
    shared_ptr<void> interactions;
    shared_ptr<void> energy;
    std::vector<shared_ptr<Material>> materials;
    shared_ptr<Bound> bound;
    shared_ptr<Cell> cell;
    std::vector<shared_ptr<Serializable>> miscParams;
    std::vector<shared_ptr<Serializable>> dispParams;

    Scene();
    virtual ~Scene();
    std::string getClassName() const override;
};

}  // namespace yade
