// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "batches.h"
#include "choices.h"
#include "limitsurf/path/laid_path.h"
#include "limitsurf/path/path_fit.h"
#include "limitsurf/path/path_smoothing.h"
#include "limitsurf/row_check.h"
#include "shared_surface.h"
#include "text.h"

namespace limitsurf::python {
namespace {

constexpr const char* kLayPathDoc =
    R"(Lays curves onto the limit surface, between their control points too.

points (n, 3) are the control points; handle_left and handle_right (n, 3) make the segments cubic Bezier
curves. offsets (c + 1,) divide the points into c curves, one after the other; None is one curve. closed,
one flag or (c,), joins the last point of a curve with its first.

Each point of a curve is moved to the closest point of the surface. Between control points the path is
refined until its straight segments are within tolerance of the surface, and of the projection of the
curve. Segments are at most max_step long.

Closest points may jump from one part of the surface to another, beyond a fold for example. There a short
way along the surface joins the path, at most 4 times as long as the gap in space. If there is none, as
between the two sides of a thin sheet, the path ends, and another one begins. If the path comes back to
the first part without a control point in between, as past an eye in a head, a short way joins both ends,
and what lies between them is left out.

Returns LaidPaths. All paths together have m points on the surface: .face (m,), .uv (m, 2), .position
(m, 3), and .place (m,), the number of the control point before each plus a parameter up to 1. Path p
consists of the rows .offsets[p] to .offsets[p + 1] - 1 and belongs to the curve .curve[p]. If .closed[p],
its last row repeats its first. It is at most .deviation[p] away from the surface.

Bounds: points are as exact as those of closest(). .deviation is measured at 15 places of each segment,
and refined around the farthest of them. It is at most tolerance, or 1e-12 of the largest coordinate. The
true maximum may be larger: by 1 % where the distance along a segment has one maximum, and by more where
a feature is narrower than a sixteenth of a segment, which max_step prevents. Cost: some 40 searches for
each segment, a tenth of a millisecond; the first short way needs a tessellation of the surface, too. A
path has about as many segments as its length has steps of max_step, or of sqrt(8 tolerance / curvature).

Raises ValueError for arrays of other shapes, rows that are not finite, offsets that do not cover the
points, a tolerance or max_step that is not above 0, and paths of more than ten million points;
MeshError where no face has a limit surface.
)";

constexpr const char* kFitPathDoc =
    R"(A curve through some points of a path on the surface, within a tolerance of it and of the surface.

The path's points are at least 2 locations, face (n,) and uv (n, 2), as lay_path() returns them. If
closed, the last one repeats the first. kind is 'bezier' (least squares, with tangents in the tangent
plane) or 'poly'. With an offset the curve runs at that distance from the surface, along the normal, and
distances are measured from there. Where the path turns by more than corner_angle (radians) a Bezier
curve keeps a corner. values (n,) are numbers such as radii, one for each point of the path: linear
interpolation between control points reproduces them to value_tolerance.

Returns PathFit: .rows (k,), the points of the path that are control points; .handle_left and .handle_right
(k, 3), None for 'poly'; .deviation, the largest distance from the surface; .error, the largest distance of
the path's points from the curve; and .resolution, by how many chords a Bezier segment is to be drawn.

Bounds: .deviation is measured on the curve as it is drawn, at the ends and in the middle of each chord. It
is at most tolerance, if the path's own segments are; .error is at most 0.6 tolerances, the chords are off
by 0.2 tolerances at most. Cost: O(n log n) and some 10 searches for each control point; where the path
runs back and forth, at most 128 for each of its points in each of log2(n) + 1 rounds.

Raises LocationError for locations that are not on the surface, MeshError for those on refused faces, and
ValueError for arrays of other shapes, fewer than 2 points, a tolerance that is not above 0, an offset that
is not finite, and a corner_angle or value_tolerance below 0.
)";

constexpr const char* kSmoothPathDoc =
    R"(Smooths a path on the surface: its points move along the surface towards a straighter path.

The path's points are at least 2 locations, face (n,) and uv (n, 2). In each iteration a point moves
towards the straight line between its neighbours, by half its weight ((n,), 0 to 1), and then to the
closest point of the surface. Its target divides the line in the ratio in which the point divided the path
at the beginning. The ends of the path stay; if closed, the last point repeats the first and moves with it.

Returns Locations: .face (n,), .uv (n, 2). Cost: one search for each point and iteration.

Raises LocationError for locations that are not on the surface, MeshError for those on refused faces, and
ValueError for arrays of other shapes, weights outside [0, 1], and a negative number of iterations.
)";

constexpr const char* kEvenPathDoc =
    R"(count points of the surface that divide a path into parts of equal length.

The path's points are at least 2 locations, face (n,) and uv (n, 2). The polyline through them is divided
into parts of equal length. The first and the last point returned are those of the path; the others are
the points of the surface that are closest to the polyline's.

Returns Locations: .face (count,), .uv (count, 2). Cost: one search for each point.

Raises LocationError for locations that are not on the surface, MeshError for those on refused faces, and
ValueError for arrays of other shapes, and for a count below 2 or above 10,000,000.
)";

Eigen::VectorXd numbers(const py::object& object, const char* name) {
  if (object.is_none()) {
    return {};
  }
  const Doubles array = doubles(object, name);
  requireVector<std::invalid_argument>(array, name);
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
}

SpaceCurves spaceCurves(const py::object& points, const py::object& left, const py::object& right,
                        const py::object& offsets, const py::object& closed) {
  SpaceCurves curves;
  curves.points = rowsOfThree(points, "points");
  if (left.is_none() != right.is_none()) {
    throw std::invalid_argument("handle_left and handle_right must be given together");
  }
  if (!left.is_none()) {
    curves.before = rowsOfThree(left, "handle_left");
    curves.after = rowsOfThree(right, "handle_right");
    if (curves.before.rows() == 0 && curves.after.rows() == 0 && curves.points.rows() > 0) {
      // For the library such curves have no handles.
      checkRows("handle_left", 0, curves.points.rows(), "points");
    }
  }
  if (offsets.is_none()) {
    curves.offsets.push_back(0);
    if (curves.points.rows() > 0) {
      curves.offsets.push_back(curves.points.rows());
    }
  } else {
    const Integers array = integers<std::invalid_argument>(offsets, "offsets");
    requireVector<std::invalid_argument>(array, "offsets");
    curves.offsets.assign(array.data(), array.data() + array.size());
  }
  const std::size_t count = curves.offsets.empty() ? 0 : curves.offsets.size() - 1;
  if (isBool(closed)) {
    curves.closed.assign(count, py::bool_(closed));
  } else {
    const py::array_t<bool> flags = booleans(closed, "closed");
    if (flags.ndim() != 1) {
      throw py::type_error("closed has shape " + shapeText(flags) + "; expected a bool, or (c,)");
    }
    curves.closed.assign(flags.data(), flags.data() + flags.size());
  }
  return curves;
}

/// The result of work(surface, search), called without the GIL.
template <typename Work>
auto onSurface(const SharedSurface& shared, int threads, const Work& work) {
  const LongCall call(shared.lock);
  return work(shared.surface(), shared.search.get(shared.surface(), threads));
}

py::object layPath(const SharedSurface& shared, const py::object& points, double tolerance,
                   const py::object& handle_left, const py::object& handle_right,
                   const py::object& offsets, const py::object& closed, double max_step,
                   int threads) {
  checkThreads(threads);
  const SpaceCurves curves = spaceCurves(points, handle_left, handle_right, offsets, closed);
  const LaidPaths laid =
      onSurface(shared, threads, [&](const LimitSurface& surface, const SurfaceSearch& search) {
        return layCurves(surface, search, curves, {tolerance, max_step, threads});
      });
  const py::object at = locations(laid.at);
  py::array_t<bool> is_closed(static_cast<py::ssize_t>(laid.closed.size()));
  std::copy(laid.closed.begin(), laid.closed.end(), is_closed.mutable_data());
  return result("LaidPaths")(at.attr("face"), at.attr("uv"), pointArray(laid.position),
                             arrayOf(laid.place), arrayOf(laid.offsets), arrayOf(laid.curve),
                             is_closed, arrayOf(laid.deviation));
}

FitKind kindOf(const std::string& name) {
  if (name != "bezier" && name != "poly") {
    throw std::invalid_argument("kind is '" + shortened(name) + "'; expected 'bezier' or 'poly'");
  }
  return name == "bezier" ? FitKind::bezier : FitKind::poly;
}

py::object fitPath(const SharedSurface& shared, const py::object& face, const py::object& uv,
                   double tolerance, const Text& kind, Flag closed, double offset,
                   double corner_angle, const py::object& values, double value_tolerance,
                   int threads) {
  checkThreads(threads);
  FitOptions options;
  options.kind = kindOf(kind);
  options.tolerance = tolerance;
  options.offset = offset;
  options.closed = closed;
  options.corner_angle = corner_angle;
  options.values = numbers(values, "values");
  options.value_tolerance = value_tolerance;
  options.threads = threads;
  const Locations path = locationsOf(shared.surface().faceCount(), face, uv);
  if (!values.is_none()) {
    checkRows("values", options.values.size(), static_cast<Eigen::Index>(path.size()), "face");
  }
  const PathFit fit =
      onSurface(shared, threads, [&](const LimitSurface& surface, const SurfaceSearch& search) {
        return limitsurf::fitPath(surface, search, path, options);
      });
  py::object left = py::none(), right = py::none();
  if (fit.before.rows() > 0) {
    left = pointArray(fit.before);
    right = pointArray(fit.after);
  }
  return result("PathFit")(arrayOf(fit.rows), left, right, fit.deviation, fit.error,
                           fit.resolution);
}

py::object smoothPath(const SharedSurface& shared, const py::object& face, const py::object& uv,
                      const py::object& weights, int iterations, Flag closed, int threads) {
  checkThreads(threads);
  const Locations path = locationsOf(shared.surface().faceCount(), face, uv);
  const Eigen::VectorXd each = numbers(maskAsNumbers(weights), "weights");
  return locations(
      onSurface(shared, threads, [&](const LimitSurface& surface, const SurfaceSearch& search) {
        return limitsurf::smoothPath(surface, search, path, each, iterations, closed, threads);
      }).at);
}

py::object evenPath(const SharedSurface& shared, const py::object& face, const py::object& uv,
                    int count, int threads) {
  checkThreads(threads);
  const Locations path = locationsOf(shared.surface().faceCount(), face, uv);
  return locations(
      onSurface(shared, threads, [&](const LimitSurface& surface, const SurfaceSearch& search) {
        return limitsurf::evenPath(surface, search, path, count, threads);
      }).at);
}

}  // namespace

void bindPaths(SurfaceClass& type) {
  using namespace py::literals;
  type.def("lay_path", &layPath, "points"_a, "tolerance"_a, py::kw_only(),
           "handle_left"_a = py::none(), "handle_right"_a = py::none(), "offsets"_a = py::none(),
           "closed"_a = false, "max_step"_a = std::numeric_limits<double>::infinity(),
           "threads"_a = 0, kLayPathDoc)
      .def("fit_path", &fitPath, "face"_a, "uv"_a, "tolerance"_a, py::kw_only(),
           "kind"_a = "bezier", "closed"_a = false, "offset"_a = 0.,
           "corner_angle"_a = FitOptions().corner_angle, "values"_a = py::none(),
           "value_tolerance"_a = 0., "threads"_a = 0, kFitPathDoc)
      .def("smooth_path", &smoothPath, "face"_a, "uv"_a, "weights"_a, "iterations"_a = 1,
           py::kw_only(), "closed"_a = false, "threads"_a = 0, kSmoothPathDoc)
      .def("even_path", &evenPath, "face"_a, "uv"_a, "count"_a, py::kw_only(), "threads"_a = 0,
           kEvenPathDoc);
}

}  // namespace limitsurf::python
