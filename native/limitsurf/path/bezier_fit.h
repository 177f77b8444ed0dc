// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// Tangents of a path at its points.
class PathTangents {
 public:
  /// `normals` are those of the surface; rows that are not finite are not used. Points nearer to
  /// each other than `apart` do not define a direction. A closed path repeats its first point.
  PathTangents(const Points& path, const Points& normals, double apart, bool closed);

  /// Directions are not taken across these points, of which there is a flag for each.
  void setCorners(const std::vector<char>& is_corner) { is_corner_ = is_corner; }

  /// The unit direction in which the path leaves the point, or arrives at it, seen from one side
  /// alone.
  Vector3 leaving(int row) const;
  Vector3 arriving(int row) const;
  /// The unit direction in which the path passes, seen from both sides.
  Vector3 passing(int row) const;
  /// The angle by which the path turns at the point, in radians; 0 at the ends of open paths.
  double turn(int row) const;

 private:
  /// The next row in the direction of `step`, +1 or -1, that is far enough away or a corner, or -1.
  int neighbour(int row, int step) const;
  /// The slope at the row by the parabola through the next two neighbours.
  Vector3 oneSided(int row, int step) const;
  Vector3 inPlane(const Vector3& direction, int row) const;

  const Points& path_;
  const Points& normals_;
  double apart_;
  bool closed_;
  std::vector<char> is_corner_;
};

/// A cubic Bezier segment, and how far points are from it.
struct BezierFit {
  Vector3 points[4];
  double error = 0;  ///< the largest distance
  int farthest = 0;  ///< the row of the point that is farthest away
  Eigen::VectorXd parameters;
};

/// The Bezier segment from row `first` to row `last` with these unit tangents (the second points
/// backwards) that is nearest to the rows between them by least squares.
BezierFit fitBezier(const Points& path, int first, int last, const Vector3& leaving,
                    const Vector3& arriving);

/// The segment with straight handles.
BezierFit straightBezier(const Points& path, int first, int last);

/// The number of chords that are within `tolerance` of the segment: a chord over 1/n of the
/// parameter is off by at most max |B''| / (8 n^2).
int chordsWithin(const Vector3 (&points)[4], double tolerance);

}  // namespace limitsurf
