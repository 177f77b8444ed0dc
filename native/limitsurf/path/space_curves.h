// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// Curves in space: polylines, or cubic Bezier curves. The control points of curve c are rows
/// offsets[c] to offsets[c + 1] - 1. Consecutive control points are joined by a segment; a closed
/// curve has one more, from its last control point to its first.
struct SpaceCurves {
  Points points;
  /// The handles before and after each control point, or no rows: then all segments are straight.
  Points before, after;
  std::vector<std::int64_t> offsets;
  std::vector<char> closed;  ///< for each curve whether it is closed

  std::size_t size() const { return closed.size(); }
  bool isBezier() const { return before.rows() > 0; }
  /// The number of the curve's segments.
  std::int64_t segments(std::size_t curve) const;
  /// The control point at which a segment of the curve ends.
  std::int64_t end(std::size_t curve, std::int64_t segment) const;
  /// The point at a place of a curve: the number of the segment plus a parameter in [0, 1].
  Vector3 at(std::size_t curve, double place) const;

  /// Throws std::invalid_argument naming the first row that is not finite, for handles of another
  /// number of rows, for offsets that do not cover the points in order, for another number of
  /// flags, and for a curve without points.
  void check() const;
};

/// The point of a cubic Bezier segment with these control points at t in [0, 1].
Vector3 bezierPoint(const Vector3 (&points)[4], double t);

}  // namespace limitsurf
