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
  /// Control points: (x, y) is points[indices[4 * y + x]] less the anchor, or, without indices,
  /// points[stride * y + x], which is relative to the anchor. The fourth number of each is 0.
  const double (*points)[4];
  const int* indices = nullptr;
  std::size_t stride = 4;
  bool has_nets = false;  ///< the nets of differences follow the points (derivative_nets.h)
  /// Sides with no points beyond them (see BSplineWeights).
  bool u_low, u_high, v_low, v_high;
  int turns;         ///< by how many corners the patch is turned against the face, 0 to 3
  double anchor[4];  ///< the fourth number is 0, as that of the offset
  double value_scale;
  double offset[4];
  double first_scale, second_scale;
  /// Where a normal does not meet these limits, it is NaN: it is left to the caller.
  NormalLimits normal_limits{0, 0};

  /// Parameters, `count` each: those of the patch are scale * u - a and scale * v - b. As many
  /// numbers more as kReadBeyond can be read behind them, whose values do not matter.
  const double *u, *v;
  double scale = 1;
  int a = 0, b = 0;
  static constexpr int kReadBeyond = 7;
  const std::size_t* rows;  ///< the rows that get the results
  std::size_t count;
};

/// Locations on a ring tile, which lie on the grids that are kept of its first steps (Pose::Grid).
struct GridRun {
  static constexpr int kStride = 5, kSlots = 25;
  /// The grids after 1, 2, ... `steps` steps, one behind the other; relative to the anchor.
  const double (*grids)[4];
  int steps;
  bool u_low, v_low;   ///< whether the sides at u = 0 and v = 0 have no points beyond them
  int turns;           ///< by how many corners the tile is turned against the face, 0 to 3
  double anchor[4];    ///< the fourth number is 0
  double depth_scale;  ///< 2^depth of the tile
  NormalLimits normal_limits{0, 0};  ///< as in PatchRun
  /// Parameters in the tile's frame. As many numbers more as PatchRun::kReadBeyond can be read
  /// behind them. One of u and v is larger than 2^-steps or equal; results of other rows have no
  /// meaning.
  const double *u, *v;
  const std::size_t* rows;  ///< the rows that get the results
  std::size_t count;
};

/// Locations each of which lies on a regular tile of its own, a whole Ptex face with points all
/// around.
struct SingleRun {
  static constexpr int kAnchor = 5;  ///< the point relative to which the sums are taken
  const double (*points)[4];
  const int* const* indices;         ///< for each row those of its 16 control points
  NormalLimits normal_limits{0, 0};  ///< as in PatchRun
  /// Parameters. As many numbers more as PatchRun::kReadBeyond can be read behind them.
  const double *u, *v;
  const std::size_t* rows;  ///< the rows that get the results
  std::size_t count;
};

/// Locations each of which is a sum of control points with weights of its own (FixedSamples).
///
/// Location i of the run begins at entry e = offsets[i], and its entry j is the point
/// indices[e + j]. Entry 0 is the location's anchor, relative to which the sums are taken, so that
/// it needs no weights. Those of the others are found at
/// weights + kinds (e + j - (first + i) - 1), where kinds is 1, or 3 for position, du and dv.
struct WeightedRun {
  const double (*points)[4];
  const std::size_t* offsets;  ///< count + 1 of them
  const int* indices;
  const double* weights;
  std::size_t first;        ///< how many locations come before the run
  const std::size_t* rows;  ///< the rows that get the results
  std::size_t count;
};

/// Where results go: row r of each array has its three numbers from 3 r on. Normals may be missing.
template <typename Real>
struct PatchResults {
  Real *position, *du, *dv, *duu, *duv, *dvv, *normal;
};

}  // namespace limitsurf
