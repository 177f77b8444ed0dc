// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

enum class FitKind { bezier, poly };

struct FitOptions {
  FitKind kind = FitKind::bezier;
  /// The largest distance of the fitted curve from the surface, and of the path's points from it.
  double tolerance = 0;
  /// The distance along the normal at which the curve is to run beside the surface. All distances
  /// from the surface are then counted from there; where another part of the surface is closer than
  /// that, from the path, which has to be as dense as layCurves() makes it.
  double offset = 0;
  /// Whether the path is closed: its last point repeats its first.
  bool closed = false;
  /// The path keeps a corner where it turns by more than this, in radians; elsewhere Bezier
  /// segments join smoothly.
  double corner_angle = 1.0471975511965976;
  /// No rows, or numbers at each point of the path that are interpolated linearly between the
  /// control points: they are kept to `value_tolerance`.
  Eigen::VectorXd values;
  double value_tolerance = 0;
  int threads = 0;
};

/// A curve through some of a path's points.
struct PathFit {
  std::vector<int> rows;  ///< the path's points that are control points, in order
  Points before, after;   ///< handles of Bezier curves; no rows for polylines
  /// The largest distance from the surface that was measured on the curve as it is drawn: by
  /// `resolution` chords for each segment.
  double deviation = 0;
  /// The largest distance of the path's points from the curve.
  double error = 0;
  int resolution = 1;
};

/// The largest number of chords by which a Bezier segment is drawn; a segment that would need more
/// is divided.
constexpr int kMostChords = 64;

/// Fits a curve to a path whose points lie on the surface. Its control points are points of the
/// path, so their locations are known exactly.
///
/// Bezier curves are fitted by least squares, with tangents that lie in the tangent plane (after
/// Schneider, An Algorithm for Automatically Fitting Digitized Curves, Graphics Gems 1990), and
/// polylines by the farthest point (Douglas and Peucker). In both a segment is divided until the
/// path's points are within 0.6 tolerances of it and the surface within one. The distance from the
/// surface is measured at the ends and in the middle of each chord. Between neighbouring points of
/// the path a segment is not divided any more: it is straight if the surface is nearer then.
///
/// Throws LocationError for locations that are not on the surface, and std::invalid_argument for
/// fewer than two points, a tolerance that is not above 0, and another number of values.
PathFit fitPath(const LimitSurface& surface, const SurfaceSearch& search,
                const std::vector<Location>& path, const FitOptions& options);

}  // namespace limitsurf
