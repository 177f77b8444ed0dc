// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/face_neighbors.h"
#include "limitsurf/curves/geodesic_step.h"
#include "limitsurf/curves/geodesic_tracer.h"
#include "limitsurf/curves/patch_finder.h"
#include "limitsurf/curves/side_cubics.h"

namespace limitsurf {

/// What geodesics are followed on. Lengths of walks are in the unit of the patches.
struct GeodesicGround {
  GeodesicGround(const LimitSurface& limit_surface, int threads)
      : surface(limit_surface),
        patches(limit_surface, threads, PatchUnit::own),
        tiles(patches, limit_surface.faceCount()),
        neighbors(limit_surface) {}

  /// Positions on the surface, in the unit of the patches.
  Points positions(const std::vector<Location>& at) const {
    return patches.scale() * surface.evaluate(at).position;
  }

  const LimitSurface& surface;
  SurfacePatches patches;
  FaceTiles tiles;
  FaceNeighbors neighbors;
};

/// One geodesic: a walk from patch to patch.
class GeodesicWalk {
 public:
  GeodesicWalk(const GeodesicGround& ground, const std::vector<bool>* targets)
      : ground_(ground), targets_(targets), finder_(ground.patches, ground.tiles) {}

  /// Returns whether the walk can begin.
  bool start(const Location& from, const Vector3& direction);
  /// Goes on to this length. Returns false where the walk ends before it.
  bool go(double length);

  GeodesicTracer::Stop stop() const;
  double length() const { return length_; }
  bool hit() const { return hit_; }

 private:
  /// A walk ends after so many changes of the patch in a row without progress, and so many in all.
  static constexpr int kMostChangesOnSpot = 64;
  static constexpr int kMostChanges = 1000000;
  /// So many steps a walk may take on average on each patch, and so many more in all. Most patches
  /// need one to ten; along a fold, where the surface has no tangent plane, steps become shorter
  /// than any bound.
  static constexpr int kStepsAPatch = 64, kSpareSteps = 4096;

  bool step(double most);
  bool cross(int side);
  bool enter(const Location& at, const Location& beside, const Vector3& along);
  bool pass(const Vector3& from);
  bool isTarget(int face, int side) const;

  const GeodesicGround& ground_;
  const std::vector<bool>* targets_;
  PatchFinder finder_;
  FoundPatch on_;
  GeodesicState at_;
  double length_ = 0, next_step_ = 0;
  int steps_ = 0, changes_ = 0, changes_on_spot_ = 0;
  bool hit_ = false;
};

}  // namespace limitsurf
