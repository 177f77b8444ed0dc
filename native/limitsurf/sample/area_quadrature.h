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
  Vector3 normal;  ///< the integral of ds x dt
  std::int64_t evaluations;

  /// Of a whole patch, in its own unit (PatchUnit).
  AreaSquare(const BezierPatch& patch, double relative, double absolute);
  AreaSquare() = default;

  SurfaceArea result() const { return {area, error + rounding, evaluations}; }
  bool operator<(const AreaSquare& other) const { return error < other.error; }
};

/// The areas of squares, by Gauss's rules of more and more points until one is exact enough.
///
/// The error of a rule is estimated from one application of it: where the integrand is smooth, its
/// coefficients in Legendre polynomials fall geometrically with the degree, and two of them tell
/// those of the degrees at which the rule fails. Unlike the difference between two rules, this does
/// not come out small by accident. Squares are measured side by side; none has any influence on
/// another.
class AreaQuadrature {
 public:
  /// The first rule has 6 points a side, or 4 if most squares are nearly flat. Where the error may
  /// be a part of the area (AreaSquare::relative), no less than a tenth of that is stated: the
  /// estimate may be wrong where it is very small.
  void measure(std::vector<AreaSquare>& squares, bool nearly_flat = false);

 private:
  /// A square that needs the next rule.
  struct Open {
    std::size_t square;
    bool upright;
    /// The squared norms of coefficients (RuleResults) that the last rule found.
    double highest, lower;
  };

  struct Rule;
  /// Applies the first rule to up to a block of squares. Those that are not exact enough are open.
  void measureFirst(std::vector<AreaSquare>& squares, std::size_t first, std::size_t count,
                    const Rule& rule);
  /// Applies the next rule to all open squares. Those that are exact enough are open no longer.
  void measureOpen(std::vector<AreaSquare>& squares, const Rule& rule);
  /// Takes the area that a rule found. Returns whether it is exact enough.
  static bool isExact(AreaSquare& square, Open& open, const Rule& rule, double area);
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
  /// The integral of ds x dt over all squares.
  Vector3 normal() const;

 private:
  /// A quarter of a square needs no smaller error than this part of the tolerance of all squares.
  static constexpr double kShare = 64;

  AreaQuadrature quadrature_;
  std::vector<AreaSquare> squares_;  // a heap once refine() has been called
  std::vector<AreaSquare> quarters_;
  std::int64_t evaluations_ = 0;
};

}  // namespace limitsurf
