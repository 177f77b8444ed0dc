// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/bounded_patch.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// The largest distance of a point of the box from `from`.
inline double farthestDistance(const Vector3& from, const Box& box) {
  return length(Vector3((box.high - from).cwiseMax(from - box.low)));
}

/// A core, split patch by patch towards its vertex, as far inwards as a query needs.
class CoreDescent {
 public:
  /// The descent stops where the remaining core is smaller than `gap`.
  CoreDescent(const SurfacePatches& patches, const SurfacePiece& core, double gap)
      : patches_(patches), gap_(gap), vertex_(patches.coreVertex(core)) {
    patches_.split(core, first_);
    Box box = first_.core_box;
    for (const BezierPatch& patch : first_.patches) {
      for (const BezierPatch::Point& p : patch.points) {
        box.include((patch.anchor + p).head<3>().matrix());
      }
    }
    reach_ = farthestDistance(vertex_, box);
    append(first_);
  }

  const SurfacePatches::SplitCore& firstSplit() const { return first_; }
  const Vector3& vertex() const { return vertex_; }
  /// No point of the core is farther from the vertex.
  double reach() const { return reach_; }

  /// Whether the angle between `unit`, a unit vector, and every normal of the core is below 90
  /// degrees.
  bool facesAll(const Vector3& unit) {
    for (std::size_t i = 0; i < extents_.size() || descend(); ++i) {
      if (!extents_[i].facesAll(unit)) {
        return false;
      }
    }
    return true;
  }

 private:
  void append(const SurfacePatches::SplitCore& split) {
    for (const BezierPatch& patch : split.patches) {
      extents_.push_back(BoundedPatch(patch).extent(TrialCell()));
    }
    core_ = split.core;
    rest_ = farthestDistance(vertex_, split.core_box);
  }

  /// Splits the remaining core once more. Returns false if it is too small for that.
  bool descend() {
    if (2 * rest_ <= gap_ || core_.steps >= SurfacePatches::kMostSteps) {
      return false;
    }
    SurfacePatches::SplitCore split;
    patches_.split(core_, split);
    append(split);
    return true;
  }

  const SurfacePatches& patches_;
  double gap_;
  Vector3 vertex_;
  double reach_;
  SurfacePatches::SplitCore first_;

  SurfacePiece core_;  // what remains after the last split
  double rest_;        // the reach of that
  std::vector<CellExtent> extents_;
};

}  // namespace limitsurf
