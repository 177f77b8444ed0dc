// SPDX-License-Identifier: Apache-2.0
//
// How numbers are taken as arguments, and all of pybind11: the casters must stand before all code
// that uses them, so no other file may include it.
#pragma once

#include <pybind11/cast.h>

#include <cstdint>
#include <limits>

namespace limitsurf::python {

/// Whether an object is a masked array of numpy: its mask would be lost.
bool isMasked(const pybind11::handle& object);

/// Whether an object is True or False, of Python or of numpy.
bool isBool(const pybind11::handle& object);

/// What an object gives as an integer (its __index__(), which 2.7 does not have, of whatever type);
/// a null object for all else, for booleans and for masked arrays. Another error than TypeError is
/// thrown.
pybind11::object integerOf(const pybind11::handle& object);

/// Whether an object is a scalar of numpy, as np.float32(1) and np.str_('a') are.
bool isNumpyScalar(const pybind11::handle& object);

/// What an object that is a real number gives as a float (its __float__()); a null object for all
/// else: for booleans, masked arrays, arrays with dimensions, and numpy's complex numbers, texts
/// and times, of which numpy would give a float. Errors other than those of the type or the size
/// are thrown.
pybind11::object realOf(const pybind11::handle& object);

/// pybind11 would call __int__() where there is no __index__(), which cuts off fractions, and would
/// drop the error of whatever a number's methods raise.
template <typename Integer>
class IntegerCaster {
 public:
  PYBIND11_TYPE_CASTER(Integer,
                       pybind11::detail::io_name("typing.SupportsInt | typing.SupportsIndex",
                                                 "int"));

  bool load(pybind11::handle source, bool /*convert*/) {
    const pybind11::object number = integerOf(source);
    if (!number) {
      return false;
    }
    if constexpr (std::numeric_limits<Integer>::is_signed) {
      int overflow = 0;
      const long long wide = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
      value = static_cast<Integer>(wide);
      return overflow == 0 && value == wide;
    } else {
      const unsigned long long wide = PyLong_AsUnsignedLongLong(number.ptr());
      if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        return false;
      }
      value = static_cast<Integer>(wide);
      return value == wide;
    }
  }

  static pybind11::handle cast(Integer from, pybind11::return_value_policy, pybind11::handle) {
    if constexpr (std::numeric_limits<Integer>::is_signed) {
      return PyLong_FromLongLong(from);
    } else {
      return PyLong_FromUnsignedLongLong(from);
    }
  }
};

class RealCaster {
 public:
  PYBIND11_TYPE_CASTER(double,
                       pybind11::detail::io_name("typing.SupportsFloat | typing.SupportsIndex",
                                                 "float"));

  /// Without `convert`, where another form of the function may fit better, only floats and integers
  /// of Python are taken.
  bool load(pybind11::handle source, bool convert) {
    if (!source || !(convert || PyFloat_Check(source.ptr()) || PyLong_Check(source.ptr()))) {
      return false;
    }
    const pybind11::object number = realOf(source);
    if (!number) {
      return false;
    }
    value = PyFloat_AS_DOUBLE(number.ptr());
    return true;
  }

  static pybind11::handle cast(double from, pybind11::return_value_policy, pybind11::handle) {
    return PyFloat_FromDouble(from);
  }
};

/// An argument that is True or False. pybind11 would take for a `bool` whatever has a truth value:
/// NaN, a text, an array of one number.
class Flag {
 public:
  explicit Flag(bool value = false) : value_(value) {}
  operator bool() const { return value_; }

 private:
  bool value_;
};

class FlagCaster {
 public:
  PYBIND11_TYPE_CASTER(Flag, pybind11::detail::const_name("bool"));

  bool load(pybind11::handle source, bool /*convert*/) {
    if (!source || !isBool(source)) {
      return false;
    }
    value = Flag(PyObject_IsTrue(source.ptr()) == 1);
    return true;
  }

  static pybind11::handle cast(Flag from, pybind11::return_value_policy, pybind11::handle) {
    return PyBool_FromLong(from ? 1 : 0);
  }
};

}  // namespace limitsurf::python

namespace pybind11::detail {

template <>
class type_caster<limitsurf::python::Flag> : public limitsurf::python::FlagCaster {};

template <>
class type_caster<int> : public limitsurf::python::IntegerCaster<int> {};
template <>
class type_caster<long> : public limitsurf::python::IntegerCaster<long> {};
template <>
class type_caster<long long> : public limitsurf::python::IntegerCaster<long long> {};
template <>
class type_caster<unsigned long> : public limitsurf::python::IntegerCaster<unsigned long> {};
template <>
class type_caster<unsigned long long>
    : public limitsurf::python::IntegerCaster<unsigned long long> {};
template <>
class type_caster<double> : public limitsurf::python::RealCaster {};

}  // namespace pybind11::detail

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
