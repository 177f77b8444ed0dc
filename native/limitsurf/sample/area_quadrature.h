// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_rules.h"

namespace limitsurf {

/// The area of a sum of bicubic patches, each of which is halved in both directions where that pays
/// most.
///
/// A square is integrated by rules of more and more points, until two of them agree. The errors of
/// Gauss's rules fall geometrically with the number of points where the integrand is smooth; the
/// last two differences tell the ratio, and with it the error of the last rule.
class AreaQuadrature {
 public:
  void clear();

  /// Adds a patch, in its own unit (PatchUnit). The rules end where the error is at most the larger
  /// one of `absolute` and this part of the patch's own area.
  void add(const BezierPatch& patch, double relative, double absolute);

  /// Quarters squares until the sum of all errors is below `tolerance`, or until this has made
  /// `most` squares. The squares must have been kept since clear().
  void refine(double tolerance, int most);
  /// Whether squares are kept for refine(); they are not at first.
  void keepSquares(bool keep) { keep_ = keep; }

  /// All squares together.
  SurfaceArea result() const;

 private:
  struct Square {
    double points[3][16];
    double area, error, rounding;

    bool operator<(const Square& other) const { return error < other.error; }
  };

  /// A quarter of a square needs no smaller error than this part of the tolerance of all squares.
  static constexpr double kShare = 64;

  void measure(Square& square, double relative, double absolute);

  bool keep_ = false;
  SurfaceArea sum_;           // of the squares that are not kept, and of all evaluations
  std::vector<Square> kept_;  // a heap once refine() has been called
};

}  // namespace limitsurf
