// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/ring.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// Passes the interruption point before a sum over all modes of a vertex, if it has so many faces
/// that the sum takes a twentieth of a millisecond or more. At 15,000 faces it takes some
/// milliseconds, and a batch has thousands of rows.
inline void passBeforeLongSum(const Ring& ring) {
  constexpr int kManyFaces = 1024;
  if (ring.faces >= kManyFaces) {
    InterruptionPoint::pass();
  }
}

}  // namespace limitsurf
