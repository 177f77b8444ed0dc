// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Twice the mean of the two sides of a patch along s, and along t, from its Bezier points.
inline BezierPatch::Point sidesAlongS(const BezierPatch::Point p[16]) {
  return (p[3] - p[0]) + (p[15] - p[12]);
}
inline BezierPatch::Point sidesAlongT(const BezierPatch::Point p[16]) {
  return (p[12] - p[0]) + (p[15] - p[3]);
}

}  // namespace limitsurf
