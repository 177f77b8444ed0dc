// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_turns.h"

#include <cstdint>
#include <string>
#include <vector>

#include "arrays.h"
#include "matrices.h"
#include "strand_poser.h"
#include "strand_turns.h"

namespace limitsurf::python {
namespace {

constexpr char kShortestTurnsDoc[] =
    R"((n, 3, 3) rotations by the smallest angle, from the directions of source (n, 3) to those of target (n, 3).

Vectors may have any length. If the two are opposite (closer than 1e-9 to it), the rotation axis is
perpendicular to the source, as near as possible to the world axis that is least aligned with it. The
rotation is the identity if the source is not finite, and NaN if another vector has no direction. Error:
8e-15, divided by the length of the sum of the two unit vectors. Raises ValueError for arrays of other
shapes. Cost: O(n).
)";

constexpr char kRotationMatricesDoc[] =
    R"((n, 3, 3) rotations for quaternions (n, 4), w, x, y, z, of any length; NaN where all four are 0.

Raises ValueError for an array of another shape.
)";

constexpr char kMoveStrandsDoc[] =
    R"((points, 3) float64: strands moved to new roots, and rotated about them.

A point p of strand i moves to new_roots[i] + turns[i] (p - roots[i]).

Parameters
    points: (points, 3).
    offsets: (n + 1,) integers: strand i has the points offsets[i] to offsets[i + 1] - 1. None: each
        strand has one point.
    roots, new_roots: (n, 3).
    turns: (n, 3, 3) rotations.

Raises ValueError for arrays of other shapes, and for offsets that do not begin with 0, that decrease, or
that do not end with the number of points. Cost: O(points).
)";

py::array_t<double> matrices(Rotations&& rotations) {
  return arrayIn<double>(std::move(rotations), {rotations.rows(), 3, 3});
}

py::array_t<double> turnsBetween(const py::object& source, const py::object& target) {
  const Points from = rowsOfThree(source, "source"), to = rowsOfThree(target, "target");
  return matrices(released([&] { return shortestTurns(from, to); }));
}

py::array_t<double> rotationMatrices(const py::object& quaternions) {
  Doubles array = doubles(quaternions, "quaternions");
  shapeEmpty(array, {0, 4});
  if (array.ndim() != 2 || array.shape(1) != 4) {
    throw py::value_error("quaternions has shape " + shapeText(array) + "; expected (n, 4)");
  }
  const Eigen::Map<const Quaternions> rows(array.data(), array.shape(0), 4);
  return matrices(released([&] { return rotationsOf(rows); }));
}

py::array_t<double> moveStrands(const py::object& points, const py::object& offsets,
                                const py::object& roots, const py::object& new_roots,
                                const py::object& turns) {
  Doubles rotations = doubles(turns, "turns");
  const auto turn = rotationRows(rotations, "turns");
  const std::vector<std::int64_t> begins = strandOffsets(offsets);
  const Points from = rowsOfThree(points, "points"), before = rowsOfThree(roots, "roots"),
               after = rowsOfThree(new_roots, "new_roots");
  return pointArray(released([&] { return movedStrands(from, begins, before, after, turn); }));
}

}  // namespace

void bindStrandTurns(py::module_& module) {
  using namespace py::literals;
  module.def("shortest_turns", &turnsBetween, "source"_a, "target"_a, kShortestTurnsDoc);
  module.def("rotation_matrices", &rotationMatrices, "quaternions"_a, kRotationMatricesDoc);
  module.def("move_strands", &moveStrands, "points"_a, "offsets"_a, "roots"_a, "new_roots"_a,
             "turns"_a, kMoveStrandsDoc);
}

}  // namespace limitsurf::python
