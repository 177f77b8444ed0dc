// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/core_tail.h"
#include "limitsurf/sample/dart_cell.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// All of a core, patch by patch, as far inwards as somebody asks.
class CoreDescent {
 public:
  /// What is left of the core when it is smaller than `gap` does not matter.
  CoreDescent(const SurfacePatches& patches, const SurfacePiece& core, double gap)
      : patches_(patches), gap_(gap), vertex_(patches.coreVertex(core)) {
    patches_.split(core, first_);
    Box box = first_.core_box;
    for (const BezierPatch& patch : first_.patches) {
      for (const BezierPatch::Point& p : patch.points) {
        box.include((patch.anchor + p).head<3>().matrix());
      }
    }
    reach_ = CoreTail::farthest(vertex_, box);
    append(first_);
  }

  const SurfacePatches::SplitCore& firstSplit() const { return first_; }
  const Vector3& vertex() const { return vertex_; }
  /// Nothing of the core is farther from the vertex.
  double reach() const { return reach_; }

  /// Whether all normals are less than 90 degrees from this one, of unit length.
  bool facesAll(const Vector3& unit) {
    for (std::size_t i = 0; i < extents_.size() || goOn(); ++i) {
      if (!extents_[i].facesAll(unit)) {
        return false;
      }
    }
    return true;
  }

 private:
  void append(const SurfacePatches::SplitCore& split) {
    for (const BezierPatch& patch : split.patches) {
      extents_.push_back(BoundedPatch(patch).extent(DartCell()));
    }
    core_ = split.core;
    rest_ = CoreTail::farthest(vertex_, split.core_box);
  }

  /// One step more, if it matters.
  bool goOn() {
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

  SurfacePiece core_;  // the rest
  double rest_;        // its reach
  std::vector<CellExtent> extents_;
};

}  // namespace limitsurf
