// SPDX-License-Identifier: Apache-2.0
#include "elements.h"

#include <array>
#include <string>

#include "arrays.h"

namespace limitsurf::python {
namespace {

/// Looks through an object as numpy does: lists, tuples and other sequences are looked into, texts
/// are not.
class LostElements {
 public:
  LostElements(const char* name, Booleans booleans, const char* expected)
      : name_(name), refuses_booleans_(booleans == Booleans::refused), expected_(expected) {}

  void lookAt(const py::handle& object) {
    PyObject* const o = object.ptr();
    if (isNumber(o) || PyUnicode_Check(o) || PyBytes_Check(o)) {
      return;
    }
    if (PyList_Check(o) || PyTuple_Check(o)) {
      lookInto(object);
    } else if (py::isinstance<py::array>(object)) {
      lookAtArray(object);
    } else if (isBool(object)) {
      refuseBoolean(object);
    } else if (isNumpyScalar(object)) {
      plain_ = Py_TYPE(o);
    } else if (isReadAsArray(object)) {
      lookAtArray(py::module_::import("numpy").attr("asanyarray")(object));
    } else if (isSequence(object)) {
      lookInto(object);
    }
  }

 private:
  /// The most dimensions that an array of numpy may have; numpy refuses what is nested deeper.
  static constexpr std::size_t kDeepest = 64;

  /// Whether an object is known by its type to be a number; most lists have elements of one type.
  bool isNumber(PyObject* object) const {
    return PyFloat_CheckExact(object) || PyLong_CheckExact(object) || Py_TYPE(object) == plain_;
  }

  static bool isSequence(const py::handle& object) {
    if (PySequence_Check(object.ptr()) == 0) {
      return false;
    }
    const bool has_size = PySequence_Size(object.ptr()) >= 0;
    if (!has_size) {  // numpy takes such an object for an element
      py::error_already_set error;
      if (!error.matches(PyExc_Exception)) {
        throw error;
      }
    }
    return has_size;
  }

  void lookInto(const py::handle& sequence) {
    if (depth_ == kDeepest) {
      return;
    }
    const auto elements = py::reinterpret_steal<py::object>(PySequence_Fast(sequence.ptr(), ""));
    if (!elements) {
      py::error_already_set error;
      if (!error.matches(PyExc_KeyError)) {
        throw error;
      }
      return;  // a kind of dictionary, which numpy takes for an element
    }
    std::size_t& place = places_.at(depth_++);
    // What is called for an element may change the list.
    for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(elements.ptr()); ++i) {
      PyObject* const element = PySequence_Fast_GET_ITEM(elements.ptr(), i);
      if (!isNumber(element)) {
        place = static_cast<std::size_t>(i);
        lookAt(py::reinterpret_borrow<py::object>(element));
      }
    }
    --depth_;
  }

  void lookAtArray(const py::handle& object) const {
    if (isMasked(object)) {
      if (object.is(py::module_::import("numpy.ma").attr("masked"))) {
        throw py::type_error(elementName() + " is masked: it has no value");
      }
      throw py::type_error(elementName() +
                           " is a masked array; give its values, as from filled() "
                           "or compressed()");
    }
    const auto array = py::reinterpret_borrow<py::array>(object);
    if (refuses_booleans_ && array.size() > 0 && array.dtype().kind() == 'b') {
      throw py::type_error(elementName() + " has dtype bool; expected " + expected_);
    }
  }

  void refuseBoolean(const py::handle& object) const {
    if (refuses_booleans_) {
      throw py::type_error(elementName() + " is " + valueText(object) + "; expected " + expected_);
    }
  }

  /// As in "uv[3, 1]".
  std::string elementName() const {
    std::string indices;
    for (std::size_t i = 0; i < depth_; ++i) {
      indices += (i == 0 ? "" : ", ") + std::to_string(places_.at(i));
    }
    return depth_ == 0 ? name_ : name_ + ("[" + indices + "]");
  }

  const char* name_;
  bool refuses_booleans_;
  const char* expected_;
  /// A type of numpy's scalars that is not the one of booleans.
  PyTypeObject* plain_ = nullptr;
  std::size_t depth_ = 0;
  std::array<std::size_t, kDeepest> places_{};
};

}  // namespace

bool isReadAsArray(const py::handle& object) {
  return PyObject_CheckBuffer(object.ptr()) != 0 || py::hasattr(object, "__array__") ||
         py::hasattr(object, "__array_interface__") || py::hasattr(object, "__array_struct__");
}

void refuseLostElements(const py::handle& object, const char* name, Booleans booleans,
                        const char* expected) {
  LostElements(name, booleans, expected).lookAt(object);
}

}  // namespace limitsurf::python
