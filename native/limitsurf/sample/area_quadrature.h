// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/area.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A square of a bicubic patch's parameters, of which the area is wanted.
struct AreaSquare {
  double points[3][16];  ///< the coordinates of its Bezier points, axis by axis
  /// The rules end where the error is at most the larger one of `absolute` and this part of the
  /// square's own area.
  double relative, absolute;

  double area, error, rounding;
  std::int64_t evaluations;

  /// Of a whole patch, in its own unit (PatchUnit).
  AreaSquare(const BezierPatch& patch, double relative, double absolute);
  AreaSquare() = default;

  SurfaceArea result() const { return {area, error + rounding, evaluations}; }
  bool operator<(const AreaSquare& other) const { return error < other.error; }
};

/// The areas of squares, by rules of more and more points, until two of them agree. The errors of
/// Gauss's rules fall geometrically with the number of points where the integrand is smooth; the
/// last two differences tell the ratio, and with it the error of the last rule. Squares are
/// measured side by side; none has any influence on another.
class AreaQuadrature {
 public:
  void measure(std::vector<AreaSquare>& squares);

 private:
  /// A square, and the differences between the results of one rule and the next.
  struct Open {
    std::size_t square;
    bool upright;
    double differences[5];
  };

  struct NextRule;
  /// Applies the rules of up to 4 points to squares side by side. Those that are not exact enough
  /// are open.
  void measureFirst(std::vector<AreaSquare>& squares, std::size_t first, std::size_t count);
  /// Applies the next rule to all open squares. Those that are exact enough are open no longer.
  void measureOpen(std::vector<AreaSquare>& squares, const NextRule& next);
  /// Takes the next rule's area of a square. Returns whether it is exact enough.
  static bool isExact(AreaSquare& square, Open& open, double area, const NextRule& next);
  /// Whether a square whose rule of 6 points is not exact enough has to be left so: where there are
  /// folds, which count as errors then, or where 8 points do not promise to be enough.
  static bool isDone(AreaSquare& square, const Open& open);

  std::vector<Open> open_;
};

/// The area of a sum of squares, each of which is halved in both directions where that pays most.
class RefinedArea {
 public:
  /// Starts anew with these squares.
  void start(const std::vector<AreaSquare>& squares);
  /// Quarters squares until the sum of all errors is below `tolerance`, or until this has made
  /// `most` squares.
  void refine(double tolerance, int most);
  /// All squares together.
  SurfaceArea result() const;

 private:
  /// A quarter of a square needs no smaller error than this part of the tolerance of all squares.
  static constexpr double kShare = 64;

  AreaQuadrature quadrature_;
  std::vector<AreaSquare> squares_;  // a heap once refine() has been called
  std::vector<AreaSquare> quarters_;
  std::int64_t evaluations_ = 0;
};

}  // namespace limitsurf
