// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Stratified random locations, one in each of per_side x per_side equal squares of (u, v) of every
/// Ptex face that has a surface, in face order (Lacewell & Burley 2007, figure 1). The same seed
/// gives the same locations on every machine.
///
/// Throws std::invalid_argument for a per_side below 1, and for more locations than memory can
/// hold.
std::vector<Location> scatterJittered(const LimitSurface& surface, int per_side, std::uint64_t seed,
                                      int threads = 0);

/// The same locations, but on these Ptex faces alone, in their order. Faces without a surface have
/// none. Throws LocationError naming the first that is no face of the surface.
std::vector<Location> scatterJittered(const LimitSurface& surface, Span<std::int64_t> faces,
                                      int per_side, std::uint64_t seed, int threads = 0);

}  // namespace limitsurf
