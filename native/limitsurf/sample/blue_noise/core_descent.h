// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limitsurf/sample/area_kernels.h"
#include "limitsurf/sample/blue_noise/bounded_patch.h"
#include "limitsurf/surface/patches/settling_cores.h"

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
  CoreDescent(const SurfacePatches& patches, const SettlingCores& settling,
              const SurfacePiece& core, double gap)
      : patches_(patches),
        settling_cores_(settling),
        core_(core),
        gap_(gap),
        vertex_(patches.coreVertex(core)) {
    patches_.split(core, first_);
    // The corner where the three patches meet is in the middle.
    middle_point_ = first_.patches[1].anchor + first_.patches[1].points[0];
    middle_ = middle_point_.head<3>().matrix();
    append(first_);
  }

  const SurfacePatches::SplitCore& firstSplit() const { return first_; }
  const Vector3& middle() const { return middle_; }
  /// No point of the core is farther from the middle. The descent so far tells how far they are.
  double reach() const { return std::max(reach_, rest_reach_); }
  /// Splits the core so often that reach() is close to what it becomes in the end.
  void findReach() {
    while (splits_ < kReachSteps && descend()) {
    }
  }

  /// Whether the angle between `unit`, a unit vector, and every normal of the core is below 90
  /// degrees.
  bool facesAll(const Vector3& unit) {
    for (std::size_t i = 0; i < bounds_.size() || boundMore(); ++i) {
      if (!bounds_[i].facesAll(unit)) {
        return false;
      }
    }
    return true;
  }

  /// A cone that holds all normals. It descends as far as it may.
  NormalCone cone() {
    while (boundMore()) {
    }
    return NormalCone::of(bounds_, are_settled_ ? settling_.normal() : bounds_[1].normal);
  }

 private:
  /// Chosen for speed: the cores of triangles settle after one step or none.
  static constexpr int kReachSteps = 2;
  /// The normals of the rest of a core are not bounded patch by patch if they differ from that at
  /// the vertex by no more than an angle of this tangent. Chosen for speed: if a disc does not face
  /// all that is within it, smaller cores are tried.
  static constexpr double kSettledSlope = 0.5;
  /// More than the rounding of the bound on them.
  static constexpr double kSlopeRounding = 1e-9;

  void append(const SurfacePatches::SplitCore& split) {
    if (waiting_ + 3 > SquareBlock::kCount) {
      boundWaiting();
    }
    double squared = reach_ * reach_;
    for (const BezierPatch& patch : split.patches) {
      if (!are_settled_) {
        block_.put(patch, waiting_++);
      }
      const BezierPatch::Point offset(patch.anchor - middle_point_);
      for (const BezierPatch::Point& p : patch.points) {
        squared = std::max(squared, (p + offset).square().sum());
      }
    }
    reach_ = std::sqrt(squared);
    rest_ = farthestDistance(vertex_, split.core_box);
    rest_reach_ = farthestDistance(middle_, split.core_box);
    ++splits_;
  }

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

  /// Bounds the normals of the next patches, or of the whole rest. Returns false if nothing is
  /// left.
  bool boundMore() {
    if (are_settled_) {
      return false;
    }
    if (boundRest()) {
      return true;
    }
    if (waiting_ == 0 && !descend()) {
      return false;
    }
    boundWaiting();
    return true;
  }

  /// Bounds the normals of all that is nearer to the vertex than the patches whose normals are
  /// bounded already, if all of them are close to the vertex's.
  bool boundRest() {
    if (!settles_) {
      settles_ = settling_cores_.settle(core_, settling_);
    }
    if (!*settles_) {
      return false;
    }
    const int bounded_steps = static_cast<int>(bounds_.size()) / 3;
    const double slope = settling_.slopeAfter(core_.steps + bounded_steps);
    are_settled_ = slope <= kSettledSlope;
    if (are_settled_) {
      bounds_.push_back({settling_.normal(), 1, slope + kSlopeRounding});
      waiting_ = 0;
    }
    return are_settled_;
  }

  /// Bounds the normals of the patches that have been split off since the last time.
  void boundWaiting() {
    NormalBounds found;
    AreaKernels::get().normals(block_, waiting_, found);
    for (int i = 0; i < waiting_; ++i) {
      const Vector3 mean(found.mean[0][i], found.mean[1][i], found.mean[2][i]);
      bounds_.push_back({mean, length(mean), found.reach[i]});
    }
    waiting_ = 0;
  }

  const SurfacePatches& patches_;
  const SettlingCores& settling_cores_;
  const SurfacePiece core_;
  const double gap_;
  Vector3 vertex_, middle_;
  BezierPatch::Point middle_point_;
  double reach_ = 0;                         // of the patches that have been split off
  SurfacePatches::SplitCore first_, split_;  // the first one, and the last one if there are more
  // Of what remains after the last split, from the vertex and from the middle.
  double rest_, rest_reach_;
  int splits_ = 0;

  std::vector<NormalBound> bounds_;  // three for each split, and one for the rest if it has settled
  SquareBlock block_ = {};           // the patches of which the normals are not yet bounded
  int waiting_ = 0;                  // their number
  std::optional<bool> settles_;      // once it is known: whether `settling_` is set
  CoreTangents::Settling settling_;
  bool are_settled_ = false;  // the normals of the rest, so that they are bounded
};

/// What has to be known of a core to tell whether a disc covers it.
struct CoreExtent {
  int steps = -1;  ///< of the core; -1 if nothing is known
  Vector3 middle;
  double reach = 0;  ///< no point of the core is farther from the middle
  NormalCone cone;   ///< of the core, or of a larger one
};

}  // namespace limitsurf
