// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/patch_finder.h"

namespace limitsurf {
namespace {

/// More than the rounding of places on rectangles that are 2^-30 of a face wide.
constexpr double kInside = 1e-6;

bool contains(const FaceRectangle& on, const Location& at, double margin) {
  const PatchPlace place = placeOn(on, at);
  return place.s >= -margin && place.s <= 1 + margin && place.t >= -margin && place.t <= 1 + margin;
}

}  // namespace

PatchPlace placeOn(const FaceRectangle& on, const Location& at) {
  const double u = at.u - on.u0, v = at.v - on.v0;
  return {(u * on.us + v * on.vs) / (on.us * on.us + on.vs * on.vs),
          (u * on.ut + v * on.vt) / (on.ut * on.ut + on.vt * on.vt)};
}

bool PatchFinder::find(const Location& at, FoundPatch& out) {
  pieces_.clear();
  for (int tile = tiles_.begin(at.face); tile < tiles_.end(at.face); ++tile) {
    patches_.appendPieces(tile, pieces_);
  }
  for (const double margin : {0., kInside}) {
    for (const SurfacePiece& piece : pieces_) {
      if (!contains(patches_.rectangle(piece), at, margin)) {
        continue;
      }
      out.is_rest = false;
      if (!piece.isCore()) {
        out.patch = patches_.patch(piece);
        return true;
      }
      SurfacePatches::SplitCore split;
      for (SurfacePiece core = piece; core.steps < kSteps; core = split.core) {
        patches_.split(core, split);
        for (const BezierPatch& patch : split.patches) {
          if (contains(patch.on, at, margin)) {
            out.patch = patch;
            return true;
          }
        }
      }
      out.is_rest = true;
      out.patch.on = patches_.rectangle(split.core);
      return true;
    }
  }
  return false;
}

}  // namespace limitsurf
