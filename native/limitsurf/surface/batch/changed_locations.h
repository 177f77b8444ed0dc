// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/error.h"

namespace limitsurf {

/// A batch is checked before it is evaluated, but an array of another program may have been changed
/// since by another of its threads.
[[noreturn]] inline void throwChangedLocations() {
  throw LocationError("the locations were changed while they were evaluated");
}

}  // namespace limitsurf
