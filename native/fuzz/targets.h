// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace limitsurf::fuzz {

// The functions that fuzzers call. Each turns any bytes into calls of the library, and checks what
// must hold whatever the input is. Each throws Broken if it does not hold, and nothing else.

/// Control meshes of all kinds: evaluation, frames, stencils, bounds, area.
void meshTarget(const std::uint8_t* data, std::size_t size);
/// Searches, scattering, curves and polygons on such meshes.
void queryTarget(const std::uint8_t* data, std::size_t size);
/// UV maps on such meshes, and images.
void mapTarget(const std::uint8_t* data, std::size_t size);

}  // namespace limitsurf::fuzz
