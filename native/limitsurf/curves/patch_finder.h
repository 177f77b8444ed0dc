// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/side_cubics.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A bicubic patch of a surface, or what is left of a core after its last step.
struct FoundPatch {
  BezierPatch patch;
  bool is_rest = false;  ///< then `patch` holds the rectangle alone, with the vertex at s = t = 0
};

/// Finds the patch on which a location lies. Each thread needs a finder of its own.
class PatchFinder {
 public:
  /// Cores are split so often; what is left of them is 2^-16 of a face wide at most.
  static constexpr int kSteps = 16;

  PatchFinder(const SurfacePatches& patches, const FaceTiles& tiles)
      : patches_(patches), tiles_(tiles) {}

  /// The patch that contains the location. On a border any one of the patches beside it.
  /// Returns false where the face has no surface.
  bool find(const Location& at, FoundPatch& out);

 private:
  const SurfacePatches& patches_;
  const FaceTiles& tiles_;
  std::vector<SurfacePiece> pieces_;
};

/// The parameters (s, t) of a location on a rectangle of its face, without limits.
struct PatchPlace {
  double s, t;
};
PatchPlace placeOn(const FaceRectangle& on, const Location& at);

}  // namespace limitsurf
