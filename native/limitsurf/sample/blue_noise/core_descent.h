// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/area_kernels.h"
#include "limitsurf/sample/blue_noise/bounded_patch.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// The largest distance of a point of the box from `from`.
inline double farthestDistance(const Vector3& from, const Box& box) {
  return length(Vector3((box.high - from).cwiseMax(from - box.low)));
}

/// A cone that holds all normals of a part of the surface.
class NormalCone {
 public:
  bool isKnown() const { return sine_ >= 0; }
  /// Whether the angle between `unit`, a unit vector, and every normal is below 90 degrees. May be
  /// false where it is so.
  bool isFacedBy(const Vector3& unit) const {
    return unit[0] * axis_[0] + unit[1] * axis_[1] + unit[2] * axis_[2] > sine_ + kRounding;
  }

  /// The cone around the normals of these parts.
  static NormalCone of(const std::vector<NormalBound>& bounds, const Vector3& axis) {
    NormalCone cone;
    cone.sine_ = 0;
    const double axis_length = length(axis);
    for (const NormalBound& bound : bounds) {
      const double size = bound.normal_length, reach = bound.normal_reach;
      const double cosine = bound.normal.dot(axis) / (size * axis_length);
      const double sine = std::sqrt(std::max(0., 1 - cosine * cosine));
      const double spread_sine = reach / size;
      const double spread_cosine = std::sqrt(std::max(0., 1 - spread_sine * spread_sine));
      // Beyond 90 degrees there is no cone. Negated, so that this includes numbers that are NaN.
      if (!(spread_sine < 1 && cosine * spread_cosine > sine * spread_sine)) {
        cone.sine_ = kNone;
        return cone;
      }
      cone.sine_ =
          std::max(cone.sine_, static_cast<float>(sine * spread_cosine + cosine * spread_sine));
    }
    for (int i = 0; i < 3; ++i) {
      cone.axis_[i] = static_cast<float>(axis[i] / axis_length);
    }
    return cone;
  }

 private:
  static constexpr float kNone = 2;
  /// More than the rounding of this in single precision.
  static constexpr double kRounding = 1e-5;

  float axis_[3] = {};
  float sine_ = -1;  // of the angle between the axis and the farthest normal
};

/// A core, split patch by patch towards its vertex, as far inwards as a query needs.
class CoreDescent {
 public:
  /// The descent stops where the remaining core is smaller than `gap`.
  CoreDescent(const SurfacePatches& patches, const SurfacePiece& core, double gap)
      : patches_(patches), gap_(gap), vertex_(patches.coreVertex(core)) {
    patches_.split(core, first_);
    // The corner where the three patches meet is in the middle.
    middle_point_ = first_.patches[1].anchor + first_.patches[1].points[0];
    middle_ = middle_point_.head<3>().matrix();
    append(first_);
  }

  const SurfacePatches::SplitCore& firstSplit() const { return first_; }
  const Vector3& middle() const { return middle_; }
  /// No point of the core is farther from the middle. The descent so far tells how far they are.
  double reach() const { return std::max(reach_, length(Vector3(vertex_ - middle_)) + rest_); }
  /// Splits the core so often that reach() is close to what it becomes in the end.
  void findReach() {
    while (splits_ < kReachSteps && descend()) {
    }
  }

  /// Whether the angle between `unit`, a unit vector, and every normal of the core is below 90
  /// degrees.
  bool facesAll(const Vector3& unit) {
    boundNormals();
    for (std::size_t i = 0; i < bounds_.size() || descend(); ++i) {
      boundNormals();
      if (!bounds_[i].facesAll(unit)) {
        return false;
      }
    }
    return true;
  }

  /// A cone that holds all normals. It descends as far as it may.
  NormalCone cone() {
    while (descend()) {
    }
    boundNormals();
    return NormalCone::of(bounds_, bounds_[1].normal);
  }

 private:
  void append(const SurfacePatches::SplitCore& split) {
    if (waiting_ + 3 > SquareBlock::kCount) {
      boundNormals();
    }
    double squared = reach_ * reach_;
    for (const BezierPatch& patch : split.patches) {
      block_.put(patch, waiting_++);
      const BezierPatch::Point offset(patch.anchor - middle_point_);
      for (const BezierPatch::Point& p : patch.points) {
        squared = std::max(squared, (p + offset).square().sum());
      }
    }
    reach_ = std::sqrt(squared);
    rest_ = farthestDistance(vertex_, split.core_box);
    ++splits_;
  }

  /// Bounds the normals of the patches that have been appended since the last time.
  void boundNormals() {
    NormalBounds found;
    AreaKernels::get().normals(block_, waiting_, found);
    for (int i = 0; i < waiting_; ++i) {
      const Vector3 mean(found.mean[0][i], found.mean[1][i], found.mean[2][i]);
      bounds_.push_back({mean, length(mean), found.reach[i]});
    }
    waiting_ = 0;
  }

  static constexpr int kReachSteps = 3;

  /// Splits the remaining core once more. Returns false if it is too small for that.
  bool descend() {
    const SurfacePiece core = split_.core.tile < 0 ? first_.core : split_.core;
    if (2 * rest_ <= gap_ || core.steps >= SurfacePatches::kMostSteps) {
      return false;
    }
    if (split_.core.tile < 0) {
      split_ = first_;
    }
    patches_.split(core, split_);
    append(split_);
    return true;
  }

  const SurfacePatches& patches_;
  double gap_;
  Vector3 vertex_, middle_;
  BezierPatch::Point middle_point_;
  double reach_ = 0;                         // of the patches that have been split off
  SurfacePatches::SplitCore first_, split_;  // the first one, and the last one if there are more

  double rest_;  // the reach of what remains after the last split
  int splits_ = 0;
  std::vector<NormalBound> bounds_;
  SquareBlock block_ = {};  // the patches of which the normals are not yet bounded
  int waiting_ = 0;         // their number
};

/// What has to be known of a core to tell whether a disc covers it.
struct CoreExtent {
  int steps = -1;  ///< of the core; -1 if nothing is known
  Vector3 middle;
  double reach = 0;  ///< no point of the core is farther from the middle
  NormalCone cone;   ///< of the core, or of a larger one
};

}  // namespace limitsurf
