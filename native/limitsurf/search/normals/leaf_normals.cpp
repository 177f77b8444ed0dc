// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/leaf_normals.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/interruption_point.h"
#include "limitsurf/search/normals/facing.h"

namespace limitsurf {
namespace {

using Border = PieceNormals::Border;

/// A cone around the rest of a core is narrow enough if its angle is at most this, or this part of
/// that of the patches before.
constexpr double kNarrowRest = 0.05, kNarrowPart = 0.5;

/// The sides of a piece at which the surface ends.
class Borders {
 public:
  /// Adds those of a patch. Each begins at the parameter `begin`.
  void include(const BezierPatch& patch, double begin) {
    for (const unsigned side : {kSideS0, kSideS1, kSideT0, kSideT1}) {
      if (patch.borders & side) {
        const DirectionCone cone = sideCone(patch, side, begin);
        along_ = any_ ? DirectionCone::around(along_, cone) : cone;
        any_ = true;
      }
    }
  }
  void setOn(PieceNormals& piece) const {
    piece.border = !any_ ? Border::none : along_.isEverything() ? Border::unknown : Border::smooth;
    piece.along_border = along_;
  }

 private:
  bool any_ = false;
  DirectionCone along_;
};

bool isCorner(unsigned sides) {
  return (sides & (kSideS0 | kSideS1)) != 0 && (sides & (kSideT0 | kSideT1)) != 0;
}

PieceNormals ofPatch(const BezierPatch& patch) {
  PieceNormals piece;
  piece.normals = normalCone(patch);
  if (piece.normals.isEverything() || isCorner(patch.borders)) {
    piece.border = Border::unknown;
  } else {
    Borders borders;
    borders.include(patch, 0);
    borders.setOn(piece);
  }
  return piece;
}

}  // namespace

LeafNormals::LeafNormals(const SearchTree& tree) : tree_(tree), settling_(tree.patches) {}

PieceNormals LeafNormals::of(const SurfacePiece& leaf) const {
  if (!leaf.isCore()) {
    return ofPatch(tree_.patches.patch(leaf));
  }
  PieceNormals piece;
  if (tree_.rings.isLarge(tree_.patches.ringOf(leaf))) {
    piece.normals = coneOfRing(leaf);
    piece.border = Border::unknown;
  } else {
    piece.normals = coneOfCore(leaf);
    setBorder(leaf, piece);
  }
  return piece;
}

DirectionCone LeafNormals::coneOfCore(SurfacePiece core) const {
  CoreTangents::Settling settling;
  const bool settles = settling_.settle(core, settling);
  DirectionCone cone;
  cone.axis = settles ? settling.normal()
                      : frameNormal(tree_.surface, tree_.patches.rectangle(core).at(0, 0));
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  do {
    stride.step();
    tree_.patches.splitPatches(core, split);
    for (const BezierPatch& patch : split.patches) {
      cone = DirectionCone::around(cone, normalCone(patch));
    }
    core = split.core;
    if (settles) {
      const double rest = std::atan(settling.slopeAfter(core.steps)) + DirectionCone::kMargin;
      if (rest <= std::max(kNarrowRest, kNarrowPart * cone.angle)) {
        return DirectionCone::around(cone, {settling.normal(), rest});
      }
    }
  } while (!cone.isEverything() && tree_.patches.coreRadius(core) > tree_.tolerance &&
           core.steps < SurfacePatches::kMostSteps);
  return cone;
}

DirectionCone LeafNormals::coneOfRing(const SurfacePiece& first) const {
  DirectionCone cone = coneOfCore(first);
  const int ring = tree_.patches.ringOf(first), level = tree_.patches.ringLevel(first);
  for (int i = 1; i < tree_.rings.coreCount(ring) && !cone.isEverything(); ++i) {
    cone = DirectionCone::around(cone, coneOfCore(tree_.rings.core(ring, i, level)));
  }
  return cone;
}

void LeafNormals::setBorder(const SurfacePiece& core, PieceNormals& piece) const {
  piece.border = Border::unknown;
  const Location vertex = tree_.patches.rectangle(core).at(0, 0);
  if (piece.normals.isEverything() ||
      !tree_.surface.evaluate({&vertex, 1}, Derivatives::first, true, 1).normal.allFinite()) {
    return;
  }
  SurfacePatches::SplitCore split;
  tree_.patches.splitPatches(core, split);
  constexpr unsigned kFromVertex[3] = {kSideT0, 0, kSideS0};
  Borders borders;
  bool any = false;
  for (int quarter = 0; quarter < 3; ++quarter) {
    const BezierPatch& patch = split.patches[quarter];
    if ((patch.borders & ~kFromVertex[quarter]) != 0) {
      return;
    }
    // A side that leaves the vertex is one cubic, of which the patch has the half farther away.
    borders.include(patch, -1);
    any = any || patch.borders != 0;
  }
  if (!any || tree_.patches.isOnBoundaryCurve(core)) {
    borders.setOn(piece);
  }
}

}  // namespace limitsurf
