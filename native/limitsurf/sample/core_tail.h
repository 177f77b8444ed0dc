// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// Bounds on the area of the patches that a core consists of, step after step, without splitting
/// it.
///
/// After n steps the control points of a core are those of the ring, within r(n) of the vertex
/// (SurfacePatches::coreRadius()), and those beyond the ring, within o(n). A step replaces the
/// latter by means of both, in which the points beyond the ring weigh 1/4 at most, so that o(n + 1)
/// <= 3/4 r(n) + 1/4 o(n). The first derivatives of a B-spline are means of the differences of
/// neighbouring control points, so that |ds x dt| <= (2 max(r, o))^2 on each patch of the next
/// step.
class CoreTail {
 public:
  /// `box` contains the core.
  CoreTail(const SurfacePatches& patches, const SurfacePiece& core, const Box& box)
      : CoreTail(patches, core, farthest(patches.coreVertex(core), box)) {}
  /// `outer` is o(core.steps).
  CoreTail(const SurfacePatches& patches, const SurfacePiece& core, double outer)
      : patches_(patches), core_(core), outer_(outer), radius_(patches.coreRadius(core)) {}

  /// The largest distance of a point of the box from `from`.
  static double farthest(const Vector3& from, const Box& box) {
    const Vector3 d = (box.high - from).cwiseMax(from - box.low);
    return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  }

  bool ended() const { return core_.steps >= SurfacePatches::kMostSteps; }
  /// Upper bound of |ds x dt| on each of the three patches of the next step.
  double bound() const {
    const double reach = std::max(radius_, outer_);
    return 4 * reach * reach;
  }
  /// One of these three patches.
  SurfacePiece piece(int quarter) const {
    return {core_.tile, static_cast<std::int16_t>(core_.steps + 1),
            static_cast<std::int16_t>(quarter)};
  }
  double outer() const { return outer_; }

  void step() {
    outer_ = 0.75 * radius_ + 0.25 * outer_;
    ++core_.steps;
    radius_ = patches_.coreRadius(core_);
  }

  /// The sum of the bounds on the areas of all patches from here on.
  double area() const {
    CoreTail tail = *this;
    double sum = 0;
    for (; !tail.ended() && 3 * tail.bound() > kNegligible * sum; tail.step()) {
      sum += 3 * tail.bound();
    }
    return sum;
  }

 private:
  /// Bounds below this part of the sum do not change it any more.
  static constexpr double kNegligible = 1e-18;

  const SurfacePatches& patches_;
  SurfacePiece core_;
  double outer_, radius_;
};

}  // namespace limitsurf
