// SPDX-License-Identifier: Apache-2.0
#include "guides.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "batches.h"
#include "limitsurf/geodesic/guide_weights.h"
#include "limitsurf/surface/strands/child_strands.h"
#include "polylines.h"
#include "progress.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

constexpr char kGuideWeightsDoc[] =
    R"(guide_weights(guide_face, guide_uv, face, uv, count=4, *, cuts=None, cut_points=None, cut_offsets=None,
              threads=0, progress=None)

The nearest guides of each place, and their weights: what children of hair need. Distances are measured
along the surface, not through the air: a guide on the upper lip is far from a place on the lower one.

Parameters
    guide_face, guide_uv: (g,) Ptex faces and (g, 2): the roots of the guides.
    face, uv: (n,) and (n, 2): the places.
    count: guides of each place, 1 to 16.
    cuts: (m, 2) integers, pairs of vertices: edges of the control mesh that part the hair. Distances
        are not measured across them, but may go around the end of a row of edges. To separate regions,
        give all edges between them.
    cut_points: (p, 3): the points of curves that part the hair in the same way. A curve consists of
        straight lines between its points, which are projected to the closest points of the surface. A
        closed curve ends with its first point. Distances may go around an end of a curve, unless the
        end lies on a border or on another curve.
    cut_offsets: (k + 1,) integers: curve i has the points cut_offsets[i] to cut_offsets[i + 1] - 1.
        None: all points are one curve.
    threads: 0 uses all cores.
    progress: a function that is called from time to time with the part of the work that is done, 0 to
        1; an exception that it raises ends the call.

Returns GuideWeights: .guide (n, count) int32, .weight and .distance (n, count), the nearest first. The
weight of a guide at the distance d is ((1 - d / R) / d)^2, scaled so that the weights add up to 1. R is
the distance of the next guide, which gets no weight (Franke & Nielson 1980). So a guide's weight goes to
0 where another guide takes its place, and at the root of a guide only this guide has a weight. Where
fewer guides can be reached, guide is -1, weight 0 and distance inf.

Error: distances are measured on triangles whose vertices lie on the surface, by fast marching with
circular wave fronts. They are within 1 % from an eighth of a face's side on, and on flat surfaces within
5e-3 of such a side, except behind cuts and borders. A few distances may be off by up to 4 %: those around
the end of a cut that is within a face of both ends of the way; one in a thousand around a pole, where
guides are closer together than the triangles are long; and one in 2,500 where there are more than five
guides on each face. Distances are those of the present pose; for distances in the
world, pose the surface there. The result has the same bits for any number of threads.

Raises LocationError and MeshError as evaluate() does, MeshError for cuts that are no edges of the mesh,
naming the row, and ValueError for a count out of range, for points and offsets of curves of other shapes,
for offsets that do not begin with 0, decrease, or do not end with p, for a point that is not finite, and
for curves that are more than 30 million times as long as half a side of the triangles.
Cost for a mesh of 10,000 faces and 1,000 guides:
some seconds, and a microsecond for each place. Memory: 24 bytes for each of some 160,000 vertices and
count + 5, and 20 for each guide of a place.)";

constexpr char kResampleDoc[] =
    R"(resample_strands(points, offsets, count, *, threads=0)

(strands, count, 3) float64: polylines resampled to points at equal distances along them. Strand i has
the points (p, 3) from offsets[i] to offsets[i + 1] - 1, at least one; its first and its last point stay.
Raises ValueError for arrays of other shapes, a count below 2, and a strand without points.)";

constexpr char kChildrenDoc[] =
    R"(child_strands(guide_points, guide_normals, guide, weight, roots, normals, *, threads=0, progress=None)

Strands of hair (children) that take their shapes from the guides around them.

Parameters
    guide_points: (g, p, 3): the guides, all with the same number of points (resample_strands()).
    guide_normals: (g, 3): unit normals of the surface at their roots.
    guide, weight: (n, k): those of guide_weights(). -1 with the weight 0 stands for no guide.
    roots, normals: (n, 3): where the children stand, and the unit normals there.
    threads: 0 uses all cores.
    progress: as for guide_weights().

Returns (n, p, 3) float32. Each guide, relative to its first point, is rotated by the smallest angle from
the normal at its root to the normal at the child's root. The child is the weighted mean of these shapes,
scaled about its root so that its length is the weighted mean of the guides' lengths. Its first point is
its root.

Raises ValueError for arrays of other shapes, and for a guide that does not exist, naming the row. Cost:
some nanoseconds for each point and guide.)";

template <typename T>
py::array_t<T> table(std::vector<T>&& values, std::size_t rows, int columns) {
  return arrayIn<T>(std::move(values), {static_cast<py::ssize_t>(rows), columns});
}

py::object guideWeights(const SharedSurface& shared, const py::object& guide_face,
                        const py::object& guide_uv, const py::object& face, const py::object& uv,
                        int count, const py::object& cuts, const py::object& cut_points,
                        const py::object& cut_offsets, int threads, const py::object& progress) {
  checkThreads(threads);
  const CheckedLocations guides =
      locationsOn(shared.surface(), guide_face, guide_uv, "guide_face", "guide_uv");
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const GuideOptions options{
      count, cuts.is_none() ? EdgeList{} : pairsOf(cuts, "cuts"),
      cut_points.is_none() ? Polylines{}
                           : polylinesOf(cut_points, "cut_points", cut_offsets, "cut_offsets"),
      threads, ProgressReport(progress)};
  GuideWeights found;
  {
    const LongCall call(shared.lock);
    found = limitsurf::guideWeights(shared.surface(), guides, at, options);
  }
  return result("GuideWeights")(table(std::move(found.guide), at.size(), count),
                                table(std::move(found.weight), at.size(), count),
                                table(std::move(found.distance), at.size(), count));
}

py::object resampleStrands(const py::object& points, const py::object& offsets, int count,
                           int threads) {
  const Points from = rowsOfThree(points, "points");
  const Integers array = integers<std::invalid_argument>(offsets, "offsets");
  requireVector<std::invalid_argument>(array, "offsets");
  const std::vector<std::int64_t> starts(array.data(), array.data() + array.size());
  Points made = released([&] { return resampledStrands(from, starts, count, threads); });
  return arrayIn<double>(std::move(made), {made.rows() / count, count, 3});
}

GuideStrands guideStrands(const py::object& points, const py::object& normals) {
  Doubles array = doubles(points, "guide_points");
  shapeEmpty(array, {0, 2, 3});  // the fewest points that a strand can have
  if (array.ndim() != 3 || array.shape(2) != 3) {
    throw py::value_error("guide_points has shape " + shapeText(array) + "; expected (g, p, 3)");
  }
  GuideStrands guides;
  guides.points_per_strand = static_cast<int>(array.shape(1));
  guides.points =
      Eigen::Map<const Points>(array.data(), array.shape(0) * array.shape(1), Eigen::Index{3});
  guides.normals = rowsOfThree(normals, "guide_normals");
  return guides;
}

ChildRoots childRoots(const py::object& guide, const py::object& weight, const py::object& roots,
                      const py::object& normals) {
  ChildRoots children;
  children.position = rowsOfThree(roots, "roots");
  children.normal = rowsOfThree(normals, "normals");
  Integers numbers = integers<std::invalid_argument>(guide, "guide");
  Doubles weights = doubles(weight, "weight");
  shapeEmpty(numbers, {0, 1});
  shapeEmpty(weights, {0, 1});
  if (numbers.ndim() != 2 || weights.ndim() != 2 || numbers.shape(0) != weights.shape(0) ||
      numbers.shape(1) != weights.shape(1)) {
    throw py::value_error("guide has shape " + shapeText(numbers) + " and weight " +
                          shapeText(weights) + "; expected (n, k) for both");
  }
  children.guides = static_cast<int>(numbers.shape(1));
  children.guide.reserve(static_cast<std::size_t>(numbers.size()));
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    const std::int64_t number = numbers.data()[i];
    if (number > INT32_MAX || number < INT32_MIN) {
      throw py::value_error("row " + std::to_string(i / children.guides) + ": guide " +
                            std::to_string(number) + " does not exist");
    }
    children.guide.push_back(static_cast<std::int32_t>(number));
  }
  children.weight.assign(weights.data(), weights.data() + weights.size());
  return children;
}

py::object childStrands(const py::object& guide_points, const py::object& guide_normals,
                        const py::object& guide, const py::object& weight, const py::object& roots,
                        const py::object& normals, int threads, const py::object& progress) {
  const GuideStrands guides = guideStrands(guide_points, guide_normals);
  const ChildRoots children = childRoots(guide, weight, roots, normals);
  const ProgressReport report(progress);
  FloatPoints made =
      released([&] { return limitsurf::childStrands(guides, children, threads, report); });
  return arrayIn<float>(std::move(made), {children.position.rows(), guides.points_per_strand, 3});
}

}  // namespace

void bindGuideWeights(SurfaceClass& type) {
  using namespace py::literals;
  type.def("guide_weights", &guideWeights, "guide_face"_a, "guide_uv"_a, "face"_a, "uv"_a,
           "count"_a = GuideOptions().count, py::kw_only(), "cuts"_a = py::none(),
           "cut_points"_a = py::none(), "cut_offsets"_a = py::none(), "threads"_a = 0,
           "progress"_a = py::none(), kGuideWeightsDoc);
}

void bindChildStrands(py::module_& module) {
  using namespace py::literals;
  module.def("resample_strands", &resampleStrands, "points"_a, "offsets"_a, "count"_a,
             py::kw_only(), "threads"_a = 0, kResampleDoc);
  module.def("child_strands", &childStrands, "guide_points"_a, "guide_normals"_a, "guide"_a,
             "weight"_a, "roots"_a, "normals"_a, py::kw_only(), "threads"_a = 0,
             "progress"_a = py::none(), kChildrenDoc);
}

}  // namespace limitsurf::python
