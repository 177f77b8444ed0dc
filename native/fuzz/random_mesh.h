// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fuzz/byte_reader.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::fuzz {

/// The control mesh that the bytes describe: a grid, a fan, a cube or any faces at all, with any
/// changes made to it. Null if it is refused.
std::unique_ptr<LimitSurface> readSurface(ByteReader& bytes);

/// Places on faces that have a surface; none if there is no such face.
std::vector<Location> readLocations(ByteReader& bytes, const LimitSurface& surface, int count);

/// The diagonal of the control points' bounding box.
double diagonalOf(const LimitSurface& surface);

}  // namespace limitsurf::fuzz
