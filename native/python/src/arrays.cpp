// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "elements.h"
#include "limitsurf/error.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "result_memory.h"

namespace limitsurf::python {
namespace {

/// The array that numpy makes of an object, or its TypeError or ValueError.
py::array viewed(const py::handle& object, const char* name, Booleans booleans,
                 const char* expected) {
  try {
    refuseLostElements(object, name, booleans, expected);
    const py::module_ numpy = py::module_::import("numpy");
    const py::object array = numpy.attr("asanyarray")(object);
    if (isMasked(array)) {  // by the object's __array__()
      refuseLostElements(array, name, booleans, expected);
    }
    return py::cast<py::array>(numpy.attr("asarray")(array));
  } catch (py::error_already_set& error) {  // rows of different lengths
    if (!error.matches(PyExc_ValueError)) {
      throw;
    }
    throw py::value_error(std::string(name) + " is no array: " +
                          shortened(py::cast<std::string>(py::str(error.value()))));
  }
}

/// The name of an element: "uv[3, 1]".
std::string elementText(const py::array& array, const char* name, py::ssize_t place) {
  std::string indices;
  for (py::ssize_t axis = array.ndim() - 1; axis >= 0; --axis) {
    indices.insert(0, std::to_string(place % array.shape(axis)) + (indices.empty() ? "" : ", "));
    place /= array.shape(axis);
  }
  return indices.empty() ? name : name + ("[" + indices + "]");
}

/// The two numbers of a sequence. An array without dimensions is one for Python, too.
template <typename Number>
std::pair<Number, Number> twoOf(const py::object& object, const char* name, const char* expected) {
  const auto throw_error = [&] {
    throw py::type_error(std::string(name) + " is " + valueText(object) + "; expected " + expected);
  };
  if (!py::isinstance<py::sequence>(object) || !py::isinstance<py::iterable>(object) ||
      py::len(object) != 2) {
    throw_error();
  }
  refuseLostElements(object, name, Booleans::allowed, expected);  // the caster refuses these
  py::detail::make_caster<std::pair<Number, Number>> numbers;
  if (!numbers.load(object, true)) {
    throw_error();
  }
  return py::detail::cast_op<std::pair<Number, Number>>(numbers);
}

std::string dtypeText(const py::array& array) {
  return shortened(py::cast<std::string>(py::str(array.dtype())));
}

}  // namespace

std::string shapeText(const py::array& array) {
  return py::cast<std::string>(py::str(py::tuple(array.attr("shape"))));
}

Integers integers(const py::handle& object, const char* name, RaiseText raise) {
  if (isPlain<std::int64_t>(object)) {
    return py::reinterpret_borrow<Integers>(object);
  }
  py::array array = viewed(object, name, Booleans::refused, "integers");
  if (array.dtype().kind() == 'f' && array.size() > 0 && !py::isinstance<py::array>(object)) {
    // Floats, or integers of which some need more than 63 bits.
    array = py::module_::import("numpy").attr("asarray")(object, "object");
  }
  const char kind = array.dtype().kind();
  const auto beyond = [&](const py::handle& value, std::int64_t place) {
    raise(elementText(array, name, place) + " is " + valueText(value) + ", which no index can be");
  };
  if (kind == 'O') {  // Python's own integers, which may be of any size
    Integers result(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
    std::int64_t* to = result.mutable_data();
    for (const py::handle value : array.attr("ravel")().attr("tolist")()) {
      const py::object number = integerOf(value);
      if (!number) {
        throw py::type_error(elementText(array, name, to - result.data()) + " is " +
                             valueText(value) + "; expected integers");
      }
      int overflow = 0;
      *to++ = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
      if (overflow != 0) {
        beyond(value, to - 1 - result.data());
      }
    }
    return result;
  }
  const bool empty_list = array.size() == 0 && kind == 'f';  // numpy's type for []
  if (kind != 'i' && kind != 'u' && !empty_list) {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected integers");
  }
  if (kind == 'u' && array.itemsize() == 8 && array.size() > 0) {
    const py::object largest = array.attr("max")();
    if (py::cast<std::uint64_t>(largest) > static_cast<std::uint64_t>(INT64_MAX)) {
      beyond(py::int_(largest), py::cast<std::int64_t>(array.attr("argmax")()));
    }
  }
  return py::cast<Integers>(array.attr("astype")("int64", py::arg("copy") = false));
}

py::object maskAsNumbers(const py::object& object) {
  if (!py::isinstance<py::array>(object) || isMasked(object) ||
      py::reinterpret_borrow<py::array>(object).dtype().kind() != 'b') {
    return object;
  }
  return object.attr("astype")("float32");
}

Doubles doubles(const py::handle& object, const char* name) {
  if (isPlain<double>(object)) {
    return py::reinterpret_borrow<Doubles>(object);
  }
  const py::array array = viewed(object, name, Booleans::refused, "real numbers");
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'O') {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected real numbers");
  }
  if (kind == 'O') {  // Python's own numbers
    Doubles result(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
    double* to = result.mutable_data();
    for (const py::handle value : array.attr("ravel")().attr("tolist")()) {
      const py::object number = realOf(value);
      if (!number) {
        throw py::type_error(elementText(array, name, to - result.data()) + " is " +
                             valueText(value) + "; expected real numbers");
      }
      *to++ = PyFloat_AS_DOUBLE(number.ptr());
    }
    return result;
  }
  return py::cast<Doubles>(array.attr("astype")("float64", py::arg("copy") = false));
}

Floats floats(const py::object& object, const char* name) {
  const py::array array = viewed(object, name, Booleans::refused, "real numbers");
  if (array.dtype().kind() == 'f' && array.dtype().itemsize() <= 4) {
    return py::cast<Floats>(array.attr("astype")("float32", py::arg("copy") = false));
  }
  const Doubles numbers = doubles(array, name);
  Floats rounded(std::vector<py::ssize_t>(numbers.shape(), numbers.shape() + numbers.ndim()));
  const double* const from = numbers.data();
  float* const to = rounded.mutable_data();
  forEachRow(static_cast<std::size_t>(numbers.size()),
             [&](std::size_t i) { to[i] = static_cast<float>(from[i]); });
  return rounded;
}

Floats floatsInRange(const py::object& object, const char* name) {
  Floats rounded = floats(object, name);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  const float* const end = rounded.data() + rounded.size();
  if (std::all_of(rounded.data(), end, is_finite)) {
    return rounded;
  }
  const Doubles given = doubles(object, name);
  for (py::ssize_t i = 0; i < given.size(); ++i) {
    if (is_finite(given.data()[i]) && !is_finite(rounded.data()[i])) {
      throw py::value_error(elementText(given, name, i) + " is " + numberText(given.data()[i]) +
                            ", which float32 cannot hold");
    }
  }
  return rounded;
}

std::pair<double, double> twoNumbers(const py::object& object, const char* name) {
  return twoOf<double>(object, name, "two numbers");
}

std::pair<int, int> twoIntegers(const py::object& object, const char* name) {
  return twoOf<int>(object, name, "two integers");
}

py::array_t<bool> booleans(const py::handle& object, const char* name) {
  const py::array array = viewed(object, name, Booleans::allowed, "booleans");
  if (array.dtype().kind() != 'b' && array.size() > 0) {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected booleans");
  }
  return py::array_t<bool, py::array::c_style | py::array::forcecast>::ensure(array);
}

Points rowsOfThree(const py::handle& object, const char* name) {
  Doubles array = doubles(object, name);
  requireRows<std::invalid_argument>(array, name, 3);
  return pointsOf(array);
}

std::vector<std::pair<std::int64_t, std::int64_t>> pairsOf(const py::handle& object,
                                                           const char* name) {
  Integers array = integers<MeshError>(object, name);
  requireRows<MeshError>(array, name, 2);
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  pairs.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t row = 0; row < array.shape(0); ++row) {
    pairs.emplace_back(array.at(row, 0), array.at(row, 1));
  }
  return pairs;
}

Points pointsOf(const Doubles& array, int threads) {
  constexpr std::size_t kRowsPerTask = 65536;
  Points points(array.shape(0), 3);
  const double* const from = array.data();
  const WithoutGil released;
  const InterruptionPoint point = interruptible();
  parallelFor(static_cast<std::size_t>(array.shape(0)), kRowsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                std::copy(from + 3 * begin, from + 3 * end, points.data() + 3 * begin);
              });
  return points;
}

Doubles positionRows(const py::object& positions, int vertex_count) {
  Doubles array = doubles(positions, "positions");
  shapeEmpty(array, {0, 3});
  if (array.ndim() != 2 || array.shape(1) != 3 || array.shape(0) != vertex_count) {
    throw MeshError("positions has shape " + shapeText(array) + "; expected (" +
                    std::to_string(vertex_count) + ", 3)");
  }
  return array;
}

py::array_t<double> pointArray(Points points) { return rowArray(std::move(points)); }

Output::Output(const py::dtype& dtype, std::vector<py::ssize_t> shape)
    : array_(newArray(dtype, std::move(shape))),
      data_(array_->mutable_data()),
      single_(dtype.itemsize() == 4) {}

Floats resultArray(const py::object& out, const std::string& name,
                   const std::vector<py::ssize_t>& shape) {
  if (out.is_none()) {
    return newArray(py::dtype::of<float>(), shape);
  }
  refuseLostElements(out, name.c_str(), Booleans::allowed, "an array of float32");
  if (!py::isinstance<Floats>(out)) {
    throw py::type_error(name + " is no contiguous array of float32");
  }
  Floats array = py::reinterpret_borrow<Floats>(out);
  if (!array.writeable()) {
    throw py::type_error(name + " is read-only");
  }
  const std::vector<py::ssize_t> given(array.shape(), array.shape() + array.ndim());
  if (given != shape) {
    const auto expected = py::cast<std::string>(py::str(py::tuple(py::cast(shape))));
    throw py::value_error(name + " has shape " + shapeText(array) + "; expected " + expected);
  }
  return array;
}

void Output::put(std::size_t offset, const double* from, std::size_t count) {
  if (single_) {
    float* to = static_cast<float*>(data_) + offset;
    for (std::size_t i = 0; i < count; ++i) {
      to[i] = static_cast<float>(from[i]);
    }
  } else if (count > 0) {
    std::memcpy(static_cast<double*>(data_) + offset, from, count * sizeof(double));
  }
}

py::dtype floatType(const py::object& dtype) {
  static const py::handle usual = py::dtype::of<double>().release();  // for good
  if (dtype.is(usual)) {
    return py::reinterpret_borrow<py::dtype>(dtype);
  }
  py::dtype result;
  try {
    result = py::dtype::from_args(dtype);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) {
      throw;
    }
    throw py::type_error("dtype is " + valueText(dtype) + "; expected float64 or float32");
  }
  if (result.kind() != 'f' || (result.itemsize() != 8 && result.itemsize() != 4) ||
      !py::cast<bool>(result.attr("isnative"))) {
    throw py::type_error("dtype is " + shortened(py::cast<std::string>(py::str(result))) +
                         "; expected float64 or float32 in the machine's byte order");
  }
  return result;
}

}  // namespace limitsurf::python
