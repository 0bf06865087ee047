#pragma once

#include <core/Timing.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Scene;

class Engine : public Serializable {
public:
    Scene* scene;
    TimingInfo timingInfo;
    shared_ptr<TimingDeltas> timingDeltas;
    bool dead;
    int ompThreads;
    std::string label;

    Engine();
    virtual ~Engine();
    std::string getBaseClassName(unsigned int i = 0) const override;
    int getBaseClassNumber() const override;
    std::string getClassName() const override;
    void pySetAttr(const std::string& key, const boost::python::object& value) override;
    boost::python::dict pyDict() const override;
    void callPostLoad() override;
    void pyRegisterClass(boost::python::object scope) override;
    virtual bool isActivated();
    virtual void action();

private:
    friend class boost::serialization::access;
    template <class Archive>
    void serialize(Archive& archive, unsigned int)
    {
        archive& BOOST_SERIALIZATION_BASE_OBJECT_NVP(Serializable);
        archive& BOOST_SERIALIZATION_NVP(dead);
        archive& BOOST_SERIALIZATION_NVP(ompThreads);
        archive& BOOST_SERIALIZATION_NVP(label);
    }
};

}  // namespace yade

BOOST_CLASS_EXPORT_KEY(yade::Engine)
