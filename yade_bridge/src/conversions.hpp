#pragma once

#include "lbm/solid.hpp"

#include <boost/python.hpp>

#include <array>
#include <string>
#include <vector>

namespace yadelbm {

/// @name From Python. A value of another kind is an error, both TypeError and ValueError, that names the attribute and what it wants.
///@{
void from_python(const char* name, const boost::python::object& value, double& result);
void from_python(const char* name, const boost::python::object& value, int& result);
void from_python(const char* name, const boost::python::object& value, bool& result);
void from_python(const char* name, const boost::python::object& value, std::string& result);
void from_python(const char* name, const boost::python::object& value, lbm::Vec3& result);
void from_python(const char* name, const boost::python::object& value, std::vector<int>& result);
void from_python(const char* name, const boost::python::object& value, std::vector<double>& result);
void from_python(const char* name, const boost::python::object& value, std::vector<std::string>& result);
void from_python(const char* name, const boost::python::object& value, std::vector<lbm::Vec3>& result);
///@}

/// @name To Python: vectors become YADE's Vector3 and Matrix3, lists of them lists.
///@{
boost::python::object to_python(double value);
boost::python::object to_python(int value);
boost::python::object to_python(bool value);
boost::python::object to_python(const std::string& value);
boost::python::object to_python(const lbm::Vec3& v);
boost::python::object to_python(const lbm::Mat3& m);
boost::python::object to_python(const std::vector<int>& values);
boost::python::object to_python(const std::vector<double>& values);
boost::python::object to_python(const std::vector<std::string>& values);
boost::python::object to_python(const std::vector<lbm::Vec3>& values);
///@}

/// A NumPy array of doubles that owns its data, last axis fastest.
boost::python::object numpy_array(const std::vector<double>& values, const std::vector<int>& shape);

}  // namespace yadelbm
