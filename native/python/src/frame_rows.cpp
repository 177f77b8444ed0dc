// SPDX-License-Identifier: Apache-2.0
#include "frame_rows.h"

#include <string>
#include <utility>

#include "arrays.h"
#include "limitsurf/surface/strands/frame_rows.h"
#include "locks/signals.h"
#include "matrices.h"

namespace limitsurf::python {
namespace {

constexpr char kQuaternionsDoc[] =
    R"((n, 4) unit quaternions w, x, y, z with w >= 0 for rotations (n, 3, 3); NaN where they are not finite.

Error: 2e-15. Raises ValueError for an array of another shape. Cost: O(n).
)";

constexpr char kFramesInWorldDoc[] =
    R"((n, 3, 3) frames of an object, transformed to the world.

Parameters
    frames: (n, 3, 3), with the columns tangent, normal x tangent, normal, as surface.frames() gives them.
    matrix: (3, 3), which maps the object's vectors to the world's.

The tangent is transformed by the matrix, and the normal remains perpendicular to the surface. The column
between them is perpendicular to both and points to the side of growing v, so the frame is left-handed if
the matrix mirrors. Columns are unit vectors, NaN where they have no direction. Error: 2e-15 times the
condition number of the matrix. Raises ValueError for arrays of other shapes. Cost: O(n).
)";

constexpr char kLeaningDoc[] =
    R"((n, 3) unit vectors: the last columns of frames (n, 3, 3), turned towards the first two columns.

angles (n, 2) are in radians; the two are combined into one rotation about one axis. Error: 2e-15
times (1 + angle / 8). Raises ValueError for arrays of other shapes. Cost: O(n).
)";

constexpr char kStraightStrandsDoc[] =
    R"((n, points, 3) float32: straight strands, evenly spaced from each root to root + along.

roots and along are (n, 3). A strand of one point is its root. Points are computed in float64 and then rounded.
`out`, a contiguous array of float32 of the result's shape, receives the result and is returned.
Raises ValueError for arrays of other shapes and for points below 1. Cost: O(n points).
)";

template <typename Rows>
Eigen::Map<const Rows> rows(Doubles& array, const char* name) {
  requireRows<std::invalid_argument>(array, name, Rows::ColsAtCompileTime);
  return {array.data(), array.shape(0), Rows::ColsAtCompileTime};
}

py::array_t<double> quaternionRows(const py::object& rotations, int threads) {
  Doubles array = doubles(rotations, "rotations");
  const auto from = rotationRows(array, "rotations");
  return rowArray(released([&] { return quaternionsOf(from, threads); }));
}

py::array_t<double> worldFrames(const py::object& frames, const py::object& matrix, int threads) {
  Doubles array = doubles(frames, "frames"), linear = doubles(matrix, "matrix");
  const auto from = rotationRows(array, "frames");
  if (linear.ndim() != 2 || linear.shape(0) != 3 || linear.shape(1) != 3) {
    throw py::value_error("matrix has shape " + shapeText(linear) + "; expected (3, 3)");
  }
  const Eigen::Matrix3d by =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(linear.data());
  Rotations result = released([&] { return framesInWorld(from, by, threads); });
  const Eigen::Index count = result.rows();
  return arrayIn<double>(std::move(result), {count, 3, 3});
}

py::array_t<double> leaningRows(const py::object& frames, const py::object& angles, int threads) {
  Doubles array = doubles(frames, "frames"), pairs = doubles(angles, "angles");
  const auto from = rotationRows(array, "frames");
  const auto by = rows<Pairs>(pairs, "angles");
  return rowArray(released([&] { return leaning(from, by, threads); }));
}

Floats strandRows(const py::object& roots, const py::object& along, int points,
                  const py::object& out, int threads) {
  Doubles from = doubles(roots, "roots"), to = doubles(along, "along");
  const auto root = rows<Points>(from, "roots"), whole = rows<Points>(to, "along");
  if (out.is_none() || points < 1) {
    FloatPoints result = released([&] { return straightStrands(root, whole, points, threads); });
    return arrayIn<float>(std::move(result), {root.rows(), points, 3});
  }
  Floats strands = resultArray(out, "out", {root.rows(), points, 3});
  const Eigen::Map<FloatPoints> into(strands.mutable_data(), root.rows() * points, 3);
  released([&] { straightStrands(root, whole, points, into, threads); });
  return strands;
}

}  // namespace

void bindFrameRows(py::module_& module) {
  using namespace py::literals;
  module.def("quaternions", &quaternionRows, "rotations"_a, py::kw_only(), "threads"_a = 0,
             kQuaternionsDoc);
  module.def("frames_in_world", &worldFrames, "frames"_a, "matrix"_a, py::kw_only(),
             "threads"_a = 0, kFramesInWorldDoc);
  module.def("leaning", &leaningRows, "frames"_a, "angles"_a, py::kw_only(), "threads"_a = 0,
             kLeaningDoc);
  module.def("straight_strands", &strandRows, "roots"_a, "along"_a, "points"_a,
             "out"_a = py::none(), py::kw_only(), "threads"_a = 0, kStraightStrandsDoc);
}

}  // namespace limitsurf::python
