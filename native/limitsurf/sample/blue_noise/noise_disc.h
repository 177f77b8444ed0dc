// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/types.h"

namespace limitsurf {

/// Two points see each other if the angle between their unit normals is less than 90 degrees. A
/// scalar product up to this constant counts as 90 degrees, because of its rounding.
constexpr double kRightAngle = 1e-9;
inline bool seeEachOther(const Vector3& a, const Vector3& b) { return a.dot(b) > kRightAngle; }

/// The disc that a point keeps free of others that it sees, in one line of the cache.
struct alignas(64) NoiseDisc {
  Vector3 position, normal;
  double radius;
  /// Of two discs in conflict, the one with the lower rank stays: finite, and kAccepted once it has
  /// been accepted.
  double rank;
  static constexpr double kAccepted = -1;

  /// Sets nothing, so that lists of discs can be made longer and filled in parallel.
  NoiseDisc() {}
};

/// Discs side by side. Places that hold none are filled with discs that are in conflict with
/// nothing.
struct DiscBlock {
  static constexpr int kCount = 8;

  double position[3][kCount], normal[3][kCount];
  double radius[kCount], rank[kCount], number[kCount];
};

}  // namespace limitsurf
