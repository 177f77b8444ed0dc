// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// per_side x per_side stratified random locations on each Ptex face that has a surface (paper,
/// figure 1), in face order. The same seed gives the same locations on every machine.
std::vector<Location> scatterJittered(const LimitSurface& surface, int per_side, std::uint64_t seed,
                                      int threads = 0);

}  // namespace limitsurf
