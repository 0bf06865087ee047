#pragma once

#include <core/Engine.hpp>

namespace yade {

class GlobalEngine : public Engine {
public:
    GlobalEngine() {}
    virtual ~GlobalEngine();
    std::string getBaseClassName(unsigned int i = 0) const override;
    int getBaseClassNumber() const override;
    std::string getClassName() const override;
    void pySetAttr(const std::string& key, const boost::python::object& value) override;
    boost::python::dict pyDict() const override;
    void callPostLoad() override;
    void pyRegisterClass(boost::python::object scope) override;

private:
    friend class boost::serialization::access;
    template <class Archive>
    void serialize(Archive& archive, unsigned int)
    {
        archive& BOOST_SERIALIZATION_BASE_OBJECT_NVP(Engine);
    }
};

}  // namespace yade

BOOST_CLASS_EXPORT_KEY(yade::GlobalEngine)
