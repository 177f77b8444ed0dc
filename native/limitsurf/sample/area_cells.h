// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A part of the surface with a bound on its area: a dyadic square of a patch's parameters, or a
/// core.
struct AreaCell {
  SurfacePiece piece;
  std::uint16_t column = 0, row = 0;  ///< of 2^level each
  std::uint8_t level = 0;
  /// On a patch, an upper bound of |ds x dt| with respect to the cell's own (s, t) in [0, 1]^2. Of
  /// a core, the sum of such bounds over its patches, by CoreTail.
  float bound = 0;
  float area = 0;       ///< estimated
  float least = 0;      ///< a lower bound of |ds x dt|, 0 where none is known
  float outer[3] = {};  ///< of a core: what CoreTail starts from
};

/// The surface cut into cells so small that the area of each is close to its bound, in face order.
/// There are none where |ds x dt| of all patches is nothing but rounding errors: where the surface
/// is collapsed to lines and points.
std::vector<AreaCell> areaCells(const SurfacePatches& patches, int threads);

/// The rectangle of the face that a cell covers.
FaceRectangle rectangleOf(const SurfacePatches& patches, const AreaCell& cell);

}  // namespace limitsurf
