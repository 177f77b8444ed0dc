// SPDX-License-Identifier: Apache-2.0
#include "batches.h"
#include "limitsurf/flow/curve_directions.h"
#include "polylines.h"
#include "progress.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

constexpr char kCurveDirectionsDoc[] =
    R"((n, 3) unit tangents of the surface that continue the directions of curves smoothly over it.

Parameters
    points: (m, 3), the points of the curves, which consist of straight lines between them. A closed
        curve ends with its first point.
    offsets: (k + 1,) integers: curve i has the points offsets[i] to offsets[i + 1] - 1. None: all
        points are one curve.
    face, uv: (n,) Ptex faces and (n, 2), as in evaluate().
    threads: 0 uses all cores.
    progress: a function that is called with the part that is done, 0 to 1.

At a curve the direction is the curve's own, from its first point to its last; it counts at the point of
the surface that is closest to the curve. Elsewhere the directions are those of the field of tangent
vectors that agrees with the curves and changes least along the surface: a place follows the curves that
are near it along the surface, and between two curves the direction turns from one to the other. Rows
are 0 where no way along the surface leads to a curve.

The field is computed on about 30,000 polygons on the limit surface, or one for each Ptex face if there
are more of these. Curves that cross one polygon in different directions are averaged there.

Raises LocationError and MeshError as evaluate() does, and ValueError for arrays of other shapes, for
offsets that do not begin with 0, decrease, or do not end with m, for a point that is not finite, for
curves of more than 30 million pieces as long as half a polygon's side, and if no part of a curve runs
along the surface. Cost, on one core: 0.35 s for 16,000 polygons, 3.5 s for 100,000. The
result has the same bits for any number of threads.
)";

py::object curveDirections(const SharedSurface& shared, const py::object& points,
                           const py::object& offsets, const py::object& face, const py::object& uv,
                           int threads, const py::object& dtype, const py::object& progress) {
  checkThreads(threads);
  const Polylines curves = polylinesOf(points, "points", offsets, "offsets");
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  Output output(floatType(dtype), {static_cast<py::ssize_t>(at.size()), 3});
  const ProgressReport report(progress);
  {
    const LongCall call(shared.lock);
    const Points found = limitsurf::curveDirections(shared.surface(), curves, at, threads, report);
    output.put(0, found.data(), 3 * at.size());
  }
  return output.object();
}

}  // namespace

void bindFlow(SurfaceClass& type) {
  using namespace py::literals;
  type.def("curve_directions", &curveDirections, "points"_a, "offsets"_a, "face"_a, "uv"_a,
           py::kw_only(), "threads"_a = 0, "dtype"_a = py::dtype("float64"),
           "progress"_a = py::none(), kCurveDirectionsDoc);
}

}  // namespace limitsurf::python
