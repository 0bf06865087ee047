#pragma once

#include "settings.hpp"

#include <boost/python/object.hpp>

#include <string>
#include <vector>

namespace yadelbm {

/// One attribute as Python sees it.
struct Attribute {
    const char* name;
    const char* doc;
    bool live;  ///< may change while the fluid exists
    boost::python::object (*get)(const Settings&);
    void (*set)(Settings&, const boost::python::object&);  ///< throws if the value is of another kind (conversions.hpp)
};

const std::vector<Attribute>& attributes();

/// @return nullptr if there is none of that name
const Attribute* find_attribute(const std::string& name);

}  // namespace yadelbm
