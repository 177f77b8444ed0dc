// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "limitsurf/types.h"
#include "locks/gil.h"
#include "locks/signals.h"
#include "numbers.h"
#include "value_text.h"

namespace limitsurf::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style>;
using Integers = py::array_t<std::int64_t, py::array::c_style>;
using Floats = py::array_t<float, py::array::c_style>;

/// Whether an object is an array that can be read as it is: contiguous and aligned numbers of this
/// type in the machine's byte order, and numpy's own class, because another one (a masked array)
/// may mean more than its numbers. This takes a few nanoseconds.
template <typename T>
bool isPlain(const py::handle& object) {
  constexpr int plainFlags = static_cast<int>(py::array::c_style) |
                             static_cast<int>(py::detail::npy_api::NPY_ARRAY_ALIGNED_);
  const auto& api = py::detail::npy_api::get();
  if (Py_TYPE(object.ptr()) != api.PyArray_Type_ ||
      !py::detail::check_flags(object.ptr(), plainFlags)) {
    return false;
  }
  return api.PyArray_EquivTypes_(py::detail::array_proxy(object.ptr())->descr,
                                 py::dtype::of<T>().ptr());
}

/// The shape of an array as text, as in "(4, 2)".
std::string shapeText(const py::array& array);

/// Throws an error with this message.
using RaiseText = void (*)(const std::string&);

/// An array of anything that numpy can view as integers; [] is an empty one. Masked arrays are
/// refused, here and below, and so are booleans among numbers, also within lists: elements.h says
/// how. Throws TypeError for floats, booleans and all else, and calls `raise` for integers beyond
/// 64 bits.
Integers integers(const py::handle& object, const char* name, RaiseText raise);

/// The same; throws Error for integers beyond 64 bits.
template <typename Error>
Integers integers(const py::handle& object, const char* name) {
  return integers(object, name, [](const std::string& text) { throw Error(text); });
}

/// An array of booleans as one of 0 and 1, where numbers may be a mask; anything else as it is.
py::object maskAsNumbers(const py::object& object);

/// An array of anything that numpy can convert to float64. Throws TypeError for all but real
/// numbers.
Doubles doubles(const py::handle& object, const char* name);

/// The same rounded to float32: numbers beyond its range become infinite, without the warning that
/// numpy would give. An array of float32 is not converted.
Floats floats(const py::object& object, const char* name);

/// The same. Throws ValueError for a finite number that would become infinite.
Floats floatsInRange(const py::object& object, const char* name);

/// The array of float32 that receives a result: `out`, or a new one. Throws TypeError unless `out`
/// is such an array, contiguous and writeable, and ValueError for another shape.
Floats resultArray(const py::object& out, const std::string& name,
                   const std::vector<py::ssize_t>& shape);

/// Throws Error quoting the shape unless the array has one dimension.
template <typename Error>
void requireVector(const py::array& array, const char* name) {
  if (array.ndim() != 1) {
    throw Error(std::string(name) + " has shape " + shapeText(array) + "; expected (n,)");
  }
}

/// The two numbers, or integers, of a tuple or another sequence. Throws TypeError for all else.
std::pair<double, double> twoNumbers(const py::object& object, const char* name);
std::pair<int, int> twoIntegers(const py::object& object, const char* name);

/// An array of booleans; [] is an empty one. Throws TypeError for all else.
py::array_t<bool> booleans(const py::handle& object, const char* name);

/// Gives [] the shape that an empty array has here.
template <typename Array>
void shapeEmpty(Array& array, std::vector<py::ssize_t> shape) {
  if (array.ndim() == 1 && array.size() == 0) {
    array = Array(std::move(shape));
  }
}

/// Throws Error quoting the shape unless the array has two dimensions and `columns` columns; [] is
/// given that shape.
template <typename Error, typename Array>
void requireRows(Array& array, const char* name, int columns) {
  shapeEmpty(array, {0, columns});
  if (array.ndim() != 2 || array.shape(1) != columns) {
    throw Error(std::string(name) + " has shape " + shapeText(array) + "; expected (n, " +
                std::to_string(columns) + ")");
  }
}

/// Releases the GIL, which may have been released before.
class WithoutGil {
 public:
  WithoutGil() {
    if (PyGILState_Check() == 1) {
      release_.emplace();
    }
  }

 private:
  std::optional<GilRelease> release_;
};

/// Calls body(i) for i below `count`, without the GIL; Ctrl-C ends that. For what passes over large
/// arrays.
template <typename Body>
void forEachRow(std::size_t count, const Body& body) {
  const WithoutGil released;
  const InterruptionPoint point = interruptible();
  InterruptionStride stride;
  for (std::size_t i = 0; i < count; ++i) {
    stride.step();
    body(i);
  }
}

/// What `work` gives, without the GIL; Ctrl-C ends it.
template <typename Work>
auto released(const Work& work) {
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  return work();
}

template <typename T>
py::array_t<T> arrayOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// An array of the numbers in a container with data(), which it takes over: copies of large ones
/// take long.
template <typename Number, typename Values>
py::array_t<Number> arrayIn(Values&& values, std::vector<py::ssize_t> shape) {
  static_assert(!std::is_reference_v<Values>, "the container is taken over");
  auto kept = std::make_unique<Values>(std::forward<Values>(values));
  auto* const numbers = reinterpret_cast<Number*>(kept->data());
  const py::capsule owner(kept.get(), [](void* p) { delete static_cast<Values*>(p); });
  kept.release();
  return py::array_t<Number>(std::move(shape), numbers, owner);
}

template <typename T, typename Allocator>
py::array_t<T> arrayOf(std::vector<T, Allocator>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return arrayIn<T>(std::move(values), {count});
}

/// The rows of a matrix, which is taken over.
template <typename Matrix>
py::array_t<typename Matrix::Scalar> rowArray(Matrix&& rows) {
  static_assert(Matrix::IsRowMajor, "numpy's order");
  return arrayIn<typename Matrix::Scalar>(std::forward<Matrix>(rows), {rows.rows(), rows.cols()});
}

/// The rows of an (n, 3) array, converted as doubles() does; [] has none. Throws
/// std::invalid_argument for other shapes.
Points rowsOfThree(const py::handle& object, const char* name);

/// The rows of an (n, 2) array of integers; [] has none. Throws MeshError for other shapes.
std::vector<std::pair<std::int64_t, std::int64_t>> pairsOf(const py::handle& object,
                                                           const char* name);

/// The points of an (n, 3) array, and the (n, 3) array of points. Ctrl-C ends what copies.
Points pointsOf(const Doubles& array, int threads = 1);
py::array_t<double> pointArray(Points points);

/// The positions of a control mesh's vertices, (vertex_count, 3). Throws MeshError for another
/// shape.
Doubles positionRows(const py::object& positions, int vertex_count);

/// An array of results, float64 or float32. Without a shape it is None.
class Output {
 public:
  Output() = default;
  Output(const py::dtype& dtype, std::vector<py::ssize_t> shape);

  /// Copies `count` numbers to the array, from its number `offset` on.
  void put(std::size_t offset, const double* from, std::size_t count);
  py::object object() const { return array_ ? py::object(*array_) : py::none(); }
  bool wanted() const { return array_.has_value(); }
  /// The numbers of the array; null without one, or if it has another type.
  template <typename Real>
  Real* numbers() const {
    return single_ == std::is_same_v<Real, float> ? static_cast<Real*>(data_) : nullptr;
  }
  bool isSingle() const { return single_; }

 private:
  std::optional<py::array> array_;
  void* data_ = nullptr;
  bool single_ = false;
};

/// The dtype, float64 or float32. Throws TypeError for another one.
py::dtype floatType(const py::object& dtype);

}  // namespace limitsurf::python
