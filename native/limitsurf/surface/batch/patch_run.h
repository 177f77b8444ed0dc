// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "limitsurf/surface/batch/normal_limits.h"

namespace limitsurf {

/// Locations on one bicubic patch, which are evaluated together.
///
/// The position is anchor + (value_scale * patch + offset), as a Jet's is; derivatives are the
/// patch's times first_scale and second_scale.
struct PatchRun {
  /// Control points, relative to the anchor: (x, y) is points[stride * y + x]. The fourth number of
  /// each is 0.
  const double (*points)[4];
  int stride;
  bool has_nets = false;  ///< the nets of differences follow the points (derivative_nets.h)
  /// Sides with no points beyond them (see BSplineWeights).
  bool u_low, u_high, v_low, v_high;
  int turns;  ///< by how many corners the patch is turned against the face, 0 to 3
  double anchor[3];
  double value_scale;
  double offset[3];
  double first_scale, second_scale;
  /// Where a normal does not meet these limits, it is NaN: it is left to the caller.
  NormalLimits normal_limits;

  const double *u, *v;      ///< parameters of the patch, `count` each
  const std::size_t* rows;  ///< the rows that get the results
  std::size_t count;
};

/// Where results go: row r of each array has its three numbers from 3 r on. Normals may be missing.
template <typename Real>
struct PatchResults {
  Real *position, *du, *dv, *duu, *duv, *dvv, *normal;
};

}  // namespace limitsurf
