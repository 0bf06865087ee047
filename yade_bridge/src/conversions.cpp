#include "conversions.hpp"

#include "lbm/errors.hpp"

#include <lib/base/Math.hpp>

#include <limits>
#include <string>

namespace yadelbm {
namespace bp = boost::python;
namespace {

/// What is bad input to this engine is a ValueError; what has the wrong type a TypeError in Python. This is both.
PyObject* wrong_type()
{
    static PyObject* const type = [] {
        const bp::tuple bases = bp::make_tuple(bp::object(bp::handle<>(bp::borrowed(PyExc_TypeError))),
                                               bp::object(bp::handle<>(bp::borrowed(PyExc_ValueError))));
        return PyErr_NewException("yadelbm.WrongType", bases.ptr(), nullptr);
    }();
    return type;
}

[[noreturn]] void type_error(const char* name, const bp::object& value, const char* wanted)
{
    const std::string got = bp::extract<std::string>(bp::str(value));
    const std::string type = bp::extract<std::string>(value.attr("__class__").attr("__name__"));
    PyErr_SetString(wrong_type(), (std::string(name) + " = " + got + ": must be " + wanted + ", not " + type).c_str());
    bp::throw_error_already_set();
    throw;  // never reached
}

template <class T>
void extract_as(const char* name, const bp::object& value, const char* wanted, T& result)
{
    const bp::extract<T> extracted(value);
    if (!extracted.check()) type_error(name, value, wanted);
    result = extracted();
}

template <class T>
void from_sequence(const char* name, const bp::object& value, const char* wanted, std::vector<T>& result)
{
    // a string is a sequence too, of letters
    if (!PySequence_Check(value.ptr()) || PyUnicode_Check(value.ptr())) type_error(name, value, wanted);
    result.resize(bp::len(value));
    for (std::size_t i = 0; i < result.size(); ++i) from_python(name, value[i], result[i]);
}

template <class T>
bp::object to_list(const std::vector<T>& values)
{
    bp::list list;
    for (const T& value : values) list.append(to_python(value));
    return list;
}

}  // namespace

void from_python(const char* name, const bp::object& value, double& result)
{
    // what says that it is a number, NumPy's scalars included
    if (!PyNumber_Check(value.ptr()) || PyUnicode_Check(value.ptr())) type_error(name, value, "a number");
    result = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred()) {
        PyErr_Clear();
        type_error(name, value, "a number");
    }
}

void from_python(const char* name, const bp::object& value, int& result)
{
    if (!PyIndex_Check(value.ptr())) type_error(name, value, "a whole number");
    const long number = PyLong_AsLong(bp::object(bp::handle<>(PyNumber_Index(value.ptr()))).ptr());
    result = static_cast<int>(number);
    if (!PyErr_Occurred() && number == result) return;
    PyErr_Clear();
    const std::string got = bp::extract<std::string>(bp::str(value));
    throw lbm::ConfigError(std::string(name) + " = " + got + ": must be within +-" +
                           std::to_string(std::numeric_limits<int>::max()));
}

void from_python(const char* name, const bp::object& value, bool& result)
{
    // Python's, NumPy's, or 0 and 1; nothing else, though everything has a truth in Python
    const std::string type = bp::extract<std::string>(value.attr("__class__").attr("__name__"));
    const bool is_truth = PyBool_Check(value.ptr()) || type == "bool_" || type == "bool";
    const int truth = is_truth || PyLong_Check(value.ptr()) ? PyObject_IsTrue(value.ptr()) : -1;
    if (truth < 0 || !(is_truth || value == bp::object(truth))) type_error(name, value, "True or False");
    result = truth == 1;
}

void from_python(const char* name, const bp::object& value, std::string& result)
{
    extract_as(name, value, "a string", result);
}

void from_python(const char* name, const bp::object& value, lbm::Vec3& result)
{
    yade::Vector3r vector;
    extract_as(name, value, "three numbers", vector);
    result = {vector[0], vector[1], vector[2]};
}

void from_python(const char* name, const bp::object& value, std::vector<int>& result)
{
    from_sequence(name, value, "a list of whole numbers", result);
}

void from_python(const char* name, const bp::object& value, std::vector<double>& result)
{
    from_sequence(name, value, "a list of numbers", result);
}

void from_python(const char* name, const bp::object& value, std::vector<std::string>& result)
{
    from_sequence(name, value, "a list of strings", result);
}

void from_python(const char* name, const bp::object& value, std::vector<lbm::Vec3>& result)
{
    from_sequence(name, value, "a list of vectors", result);
}

bp::object to_python(double value) { return bp::object(value); }

bp::object to_python(int value) { return bp::object(value); }

bp::object to_python(bool value) { return bp::object(value); }

bp::object to_python(const std::string& value) { return bp::object(value); }

bp::object to_python(const lbm::Vec3& v) { return bp::object(yade::Vector3r(v[0], v[1], v[2])); }

bp::object to_python(const lbm::Mat3& m)
{
    yade::Matrix3r matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix(i, j) = m[i][j];
    return bp::object(matrix);
}

bp::object to_python(const std::vector<int>& values) { return to_list(values); }

bp::object to_python(const std::vector<double>& values) { return to_list(values); }

bp::object to_python(const std::vector<std::string>& values) { return to_list(values); }

bp::object to_python(const std::vector<lbm::Vec3>& values) { return to_list(values); }

bp::object numpy_array(const std::vector<double>& values, const std::vector<int>& shape)
{
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    const bp::object buffer(
        bp::handle<>(PyByteArray_FromStringAndSize(bytes, static_cast<Py_ssize_t>(values.size() * sizeof(double)))));
    // a bytearray is writable and kept alive by the array on it
    return bp::import("numpy").attr("frombuffer")(buffer, "float64").attr("reshape")(bp::tuple(to_python(shape)));
}

}  // namespace yadelbm
