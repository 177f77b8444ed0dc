// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// A ray in coordinates of which the surface is near the origin; the direction is a unit vector.
struct Ray {
  Vector3 origin, direction;
};

/// A box with axes of its own, that fits a patch closely whichever way that lies. In single
/// precision; its extents allow for that.
class OrientedBox {
 public:
  /// Around points, a row each, with axes as near as can be to the two directions.
  OrientedBox(const Eigen::Ref<const Points>& points, const Vector3& along, const Vector3& across);
  /// With the coordinate axes.
  explicit OrientedBox(const Box& box);

  /// No point in the box is nearer than the root of this.
  double squaredDistance(const Vector3& point) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double beyond = std::max(0., std::abs(coordinate(i, point)) - half_[i]);
      sum += beyond * beyond;
    }
    return sum * kNearlyOne;
  }

  /// Whether the ray meets the box, widened by `margin` (a diagonal's 1e-13), between the distances
  /// `from` and `to`; `from` is raised to where it enters.
  bool meets(const Ray& ray, double margin, double& from, double to) const {
    for (int i = 0; i < 3; ++i) {
      const double start = coordinate(i, ray.origin);
      const double rate = axes_[i][0] * ray.direction[0] + axes_[i][1] * ray.direction[1] +
                          axes_[i][2] * ray.direction[2];
      const double half = half_[i] + margin;
      if (std::abs(rate) < 1e-12) {
        // As far as the surface reaches, a diagonal, it moves by 1e-12 of that across.
        if (std::abs(start) > half + 20 * margin) {
          return false;
        }
        continue;
      }
      const double a = (-half - start) / rate, b = (half - start) / rate;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from <= to;
  }

 private:
  /// Axes in single precision are unit vectors at right angles to 3e-7.
  static constexpr double kNearlyOne = 1 - 1e-6;

  double coordinate(int i, const Vector3& point) const {
    return axes_[i][0] * (point[0] - centre_[0]) + axes_[i][1] * (point[1] - centre_[1]) +
           axes_[i][2] * (point[2] - centre_[2]);
  }

  float centre_[3], axes_[3][3], half_[3];
};

}  // namespace limitsurf
