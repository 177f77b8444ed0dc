// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/types.h"

namespace limitsurf {

/// Whether a location is a corner of its face.
inline bool isCorner(const Location& at) {
  return (at.u == 0 || at.u == 1) && (at.v == 0 || at.v == 1);
}

}  // namespace limitsurf
