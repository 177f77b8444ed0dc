// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// Distances of neighbouring points of a ring after each number of steps, coordinate by coordinate
/// in the core's own frame. They are computed when they are first asked for.
class RingPitches {
 public:
  RingPitches(const SurfacePatches& patches, const SurfacePiece& core)
      : patches_(patches), core_(core), frame_(patches.coreFrame(core)) {}

  const Eigen::Matrix3d& frame() const { return frame_; }
  const Vector3& after(int steps) {
    if (!is_known_[steps]) {
      core_.steps = static_cast<std::int16_t>(steps);
      pitches_[steps] = patches_.ringPitch(core_, frame_);
      is_known_[steps] = true;
    }
    return pitches_[steps];
  }

 private:
  const SurfacePatches& patches_;
  SurfacePiece core_;
  Eigen::Matrix3d frame_;
  Vector3 pitches_[SurfacePatches::kMostSteps + 1];
  bool is_known_[SurfacePatches::kMostSteps + 1] = {};
};

/// Bounds on the area of the patches that a core consists of, step after step, without splitting
/// it.
///
/// The first derivatives of a B-spline are means of the differences of neighbouring control points.
/// After n steps, the coordinates of such a difference are at most those of d(n) where both points
/// are the ring's (RingPitches), and those of o(n) for all others. A step applies regular rules to
/// all points but the vertex itself. It makes of neighbours' differences means of halves of such
/// differences, so that o(n + 1) <= max(d(n), o(n)) / 2.
class CoreTail {
 public:
  /// The part of a core that is left after `steps` steps. `outer` is o(steps).
  CoreTail(RingPitches& pitches, int steps, const Vector3& outer)
      : pitches_(pitches), steps_(steps), outer_(outer) {}

  bool ended() const { return steps_ >= SurfacePatches::kMostSteps; }
  /// How many steps are done.
  int steps() const { return steps_; }
  /// Upper bound of |ds x dt| on each of the three patches of the next step.
  double bound() const {
    const Vector3 p = pitches_.after(steps_ + 1).cwiseMax(nextOuter());
    return kMargin * 2 *
           std::sqrt(p[0] * p[0] * (p[1] * p[1] + p[2] * p[2]) + p[1] * p[1] * p[2] * p[2]);
  }
  void step() {
    outer_ = nextOuter();
    ++steps_;
  }

  /// The sum of the bounds on the areas of all patches from here on; or a part of it, if that part
  /// is more than `most`.
  double area(double most) const {
    CoreTail tail = *this;
    double sum = 0;
    for (; !tail.ended() && !(sum > most); tail.step()) {
      const double step = 3 * tail.bound();
      if (!(step > kNegligible * sum)) {
        break;
      }
      sum += step;
    }
    return sum;
  }

 private:
  /// Bounds below this part of the sum do not change it any more.
  static constexpr double kNegligible = 1e-18;
  /// More than the rounding errors of patches and of distances.
  static constexpr double kMargin = 1 + 1e-9;

  Vector3 nextOuter() const { return outer_.cwiseMax(pitches_.after(steps_)) / 2; }

  RingPitches& pitches_;
  int steps_;
  Vector3 outer_;
};

}  // namespace limitsurf
