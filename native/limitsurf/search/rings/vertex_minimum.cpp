// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rings/vertex_minimum.h"

#include <algorithm>

#include "limitsurf/interruption_point.h"
#include "limitsurf/search/normals/local_minimum.h"

namespace limitsurf {
namespace {

/// Each patch is evaluated at so many parameters both ways, its sides included. Where the distance
/// falls, it falls along a side of the sheet or in a wide range of directions.
constexpr int kPlaces = 5;

/// The surface is looked at within these parts of the way to the searching point from the vertex,
/// or of the diagonal if that is shorter. On the smaller one its curvature changes slopes by less
/// than kFlatSlope, and on the larger one the curvature decides where the slopes vanish. Nearer
/// ones tell less: the points along a border approach the vertex faster than others, and lose
/// digits.
constexpr double kCurved = 1e-4, kFlat = 1e-7;
/// Cores must be this many times smaller than the larger one, so that a minimum in them is near the
/// vertex compared with the places that are looked at.
constexpr double kFarther = 64;

/// The rounding of points relative to the vertex, of the tolerance, which is 1e-13 of the diagonal.
constexpr double kPointRounding = 0.01;

/// How much nearer than the vertex a place must be, so that the distance counts as falling.
struct Fall {
  double slope;     ///< times the distance of the place from the vertex
  double rounding;  ///< plus this
};

/// Whether the distance falls to a place of the patch, whose points are relative to the vertex.
bool falls(const BezierPatch& patch, const Vector3& way, const Fall& least) {
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    BezierPatch::Values at;
    const int column = i % kPlaces, row = i / kPlaces;
    patch.evaluate<0>(column / (kPlaces - 1.), row / (kPlaces - 1.), at);
    const Vector3 offset = at.value.head<3>();
    // The difference of the squared distances.
    if (offset.dot(offset - 2 * way) <
        -2 * way.norm() * (least.slope * offset.norm() + least.rounding)) {
      return true;
    }
  }
  return false;
}

/// Whether the distance falls from the vertex to the surface on the cores of a ring at a level.
bool fallsAtLevel(const SearchTree& tree, int ring, int level, const Vector3& way) {
  const Fall least{kFlatSlope, kPointRounding * tree.tolerance};
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  for (int place = 0; place < tree.rings.coreCount(ring); ++place) {
    stride.step();
    tree.patches.splitPatches(tree.rings.core(ring, place, level), split);
    for (BezierPatch& patch : split.patches) {
      // The anchor of a core's patches is the vertex.
      patch.anchor.setZero();
      if (falls(patch, way, least)) {
        return true;
      }
    }
  }
  return false;
}

/// The first level at which the ring's points are within a distance of the vertex.
int levelWithin(const SearchTree& tree, int ring, double distance) {
  int level = tree.rings.firstLevel(ring);
  while (level < SurfacePatches::kMostSteps - 1 &&
         tree.patches.coreRadius(tree.rings.core(ring, 0, level)) > distance) {
    ++level;
  }
  return level;
}

/// What the scales are parts of.
double unitOf(const SearchTree& tree, const Vector3& way) {
  return std::min(way.norm(), tree.patches.diagonal());
}

}  // namespace

bool isNearVertex(const SearchTree& tree, const SurfacePiece& core, const Vector3& way) {
  return tree.patches.coreRadius(core) <= kCurved / kFarther * unitOf(tree, way);
}

bool mayHaveMinimumNear(const SearchTree& tree, int ring, const Vector3& way) {
  return !fallsAtLevel(tree, ring, levelWithin(tree, ring, kCurved * unitOf(tree, way)), way);
}

bool isFlatAtVertex(const SearchTree& tree, int ring, const Vector3& way) {
  return !fallsAtLevel(tree, ring, levelWithin(tree, ring, kFlat * unitOf(tree, way)), way);
}

}  // namespace limitsurf
