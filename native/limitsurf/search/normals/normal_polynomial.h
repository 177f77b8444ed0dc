// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/parameter_rectangle.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The normal P_s x P_t of a patch: a polynomial of degree 5 in s and in t, by its Bernstein
/// coefficients. Their directions bound those of the normal, also where the tangents turn far or
/// are nearly parallel.
class NormalPolynomial {
 public:
  /// `noise` bounds the error of the patch's points, besides rounding.
  NormalPolynomial(const BezierPatch& patch, double noise);

  /// All directions v with |v - (v . axis) axis| <= tangent * (v . axis).
  struct Cone {
    BezierPatch::Point axis;
    double tangent;  ///< infinity if nothing is known
  };
  /// A cone around the normals on a rectangle of the parameters.
  Cone cone(const ParameterRectangle& on) const;

  /// Whether no point on a rectangle of the parameters is the foot of a perpendicular: where the
  /// difference from the searching point is a multiple of the normal. `points` are the Bezier
  /// points of that part, relative to the searching point, with errors of `noise` at most.
  bool hasNoFoot(const ParameterRectangle& on, const BezierPatch::Point points[16],
                 double noise) const;

 private:
  static constexpr int kSize = 6, kCount = kSize * kSize;

  /// The coefficients of the part on a rectangle.
  void cutTo(const ParameterRectangle& on, BezierPatch::Point out[kCount]) const;

  BezierPatch::Point at_[kCount];
  double error_;  ///< bounds that of each coefficient
};

}  // namespace limitsurf
