#pragma once

#include <boost/python.hpp>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/serialization/base_object.hpp>
#include <boost/serialization/export.hpp>  // after every archive it must serve
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/vector.hpp>

#include <lib/base/Math.hpp>
#include <lib/factory/Factorable.hpp>

namespace yade {

class Serializable : public Factorable {
public:
    template <class Archive>
    void serialize(Archive&, unsigned int)
    {
    }

    Serializable() {}
    virtual ~Serializable();
    std::string getBaseClassName(unsigned int i = 0) const override;
    int getBaseClassNumber() const override;
    std::string getClassName() const override;

    void pyUpdateAttrs(const boost::python::dict& attributes);
    virtual void pySetAttr(const std::string& key, const boost::python::object& value);
    virtual boost::python::dict pyDict() const;
    virtual boost::python::dict pyDictCustom() const;
    virtual void callPostLoad();
    virtual void checkPyClassRegistersItself(const std::string& class_name) const;
    virtual void pyRegisterClass(boost::python::object scope);
    virtual void pyHandleCustomCtorArgs(boost::python::tuple& args, boost::python::dict& kw);
};

}  // namespace yade

BOOST_CLASS_EXPORT_KEY(yade::Serializable)
