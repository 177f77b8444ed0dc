// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/box_tree.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/pose/padded.h"

namespace limitsurf {

/// Points in whose convex hull a part of the surface lies, relative to an origin, and boxes around
/// them. There is at least one point when a box is asked for.
class BoxPoints {
 public:
  explicit BoxPoints(const Vector3& origin) { origin_ << origin.array(), 0; }

  void add(const BezierPatch& patch) {
    const Padded anchor = patch.anchor - origin_;
    for (const Padded& point : patch.points) {
      points_.push_back(point + anchor);
    }
  }
  void add(const CoreHull& hull) {
    Padded vertex;
    vertex << hull.vertex.array(), 0;
    vertex -= origin_;
    for (int corner = 0; corner < 8; ++corner) {
      Padded offset;
      offset << (hull.axes.transpose() * hull.corner(corner)).array(), 0;
      points_.push_back(vertex + offset);
    }
  }
  /// Boxes that are relative to the same origin.
  template <typename Real>
  void add(const OrientedBox<Real>& box) {
    for (int corner = 0; corner < 8; ++corner) {
      points_.push_back(box.corner(corner));
    }
  }

  void add(const std::vector<Padded>& points) {
    for (const Padded& point : points) {
      points_.push_back(point - origin_);
    }
  }
  void add(const BoxF& box) {
    for (int corner = 0; corner < 8; ++corner) {
      Padded point = Padded::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = (corner >> axis & 1) != 0 ? box.high[axis] : box.low[axis];
      }
      points_.push_back(point);
    }
  }

  void reserve(std::size_t count) { points_.reserve(count); }
  Vector3 point(std::size_t i) const { return points_[i].head<3>(); }

  BoxF axisAligned() const {
    Padded low = points_[0], high = low;
    for (const Padded& point : points_) {
      low = low.min(point);
      high = high.max(point);
    }
    return BoxF(Box{low.head<3>(), high.head<3>()});
  }
  template <typename Real>
  OrientedBox<Real> oriented(const Vector3& along, const Vector3& across) const {
    return {points_, along, across};
  }
  /// A box along the axes along which the points lie farthest apart.
  LeafBox alongPrincipalAxes() const;

 private:
  Padded origin_;
  std::vector<Padded> points_;
};

}  // namespace limitsurf
