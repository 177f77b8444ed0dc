// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/curve_cubic.h"
#include "limitsurf/curves/edge_place.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// The tiles of each Ptex face among those of SurfacePatches, which are in the order of the faces.
class FaceTiles {
 public:
  FaceTiles(const SurfacePatches& patches, int face_count);

  int begin(int face) const { return first_[static_cast<std::size_t>(face)]; }
  int end(int face) const { return first_[static_cast<std::size_t>(face) + 1]; }

 private:
  std::vector<int> first_;
};

/// The part of the rest of a side, relative to the length before it, that is taken to be straight
/// where the side ends at an extraordinary vertex: there the curve consists of infinitely many
/// cubics. The rest is not longer than a few times its chord, so that its share of any length is at
/// most some 1e-12.
constexpr double kStraightRest = 1e-12;

/// The limit curve of a side of a Ptex face: its cubics in order, for x from 0 to 1.
std::vector<CurveCubic> sideCubics(const SurfacePatches& patches, const FaceTiles& tiles,
                                   const FaceSide& side);

}  // namespace limitsurf
