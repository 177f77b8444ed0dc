// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The coefficients of a Bernstein polynomial of degree 6 in s and in t, as Bernstein<6> keeps
/// them.
constexpr int kDistanceStride = 8, kDistanceSize = 7 * kDistanceStride;

/// The least and the largest differences of such coefficients.
struct DifferenceBounds {
  double least_s, largest_s;    ///< first differences along s
  double least_t, largest_t;    ///< along t
  double least_ss, largest_ss;  ///< second differences
  double least_tt, largest_tt;
  double least_st, largest_st;  ///< mixed differences
};

/// The inner loops of searches for closest points, compiled for the instruction set that is in use
/// (instruction_sets.h). All sets give the same bits.
struct SearchKernels {
  /// Moves a patch's points by `offset`. Returns a lower bound of its squared distance from `away`,
  /// less the square of `away`: that of the box around the points.
  double (*move)(const double points[16][4], const double offset[4], const double away[4],
                 double out[16][4]);
  /// The squared distance of a patch from `away`, less the square of `away`: |P|^2 - 2 P away.
  void (*squaredDistance)(const double points[16][4], const double away[4],
                          double out[kDistanceSize]);
  /// The least and the largest coefficient.
  void (*extremes)(const double coefficients[kDistanceSize], double& least, double& largest);
  void (*differenceBounds)(const double coefficients[kDistanceSize], DifferenceBounds& out);
  /// A patch's value and first and second derivatives at (s, t), as BezierPatch::evaluate<2>.
  void (*evaluate)(const double points[16][4], double s, double t, double out[6][4]);

  /// The scalar products of a patch's points with a direction.
  void (*along)(const double points[16][4], const double direction[4], double out[16]);

  static const SearchKernels& get();
};

}  // namespace limitsurf
