// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/pose/padded.h"

namespace limitsurf {

/// A ray, in coordinates in which the surface lies near the origin. The direction is a unit vector.
struct Ray {
  Vector3 origin, direction;
};

/// An oriented box: it has axes of its own and fits a patch closely whichever way the patch lies.
/// Its numbers are kept as Real, float or double; its extents include their rounding.
template <typename Real>
class OrientedBox {
 public:
  OrientedBox() = default;
  /// A box around points, at least one, whose axes are as close as possible to the two directions.
  OrientedBox(Span<Padded> points, const Vector3& along, const Vector3& across);
  /// A hull, relative to `middle`.
  OrientedBox(const CoreHull& hull, const Vector3& middle);

  /// One of its eight corners.
  Padded corner(int number) const {
    Padded point = Padded::Zero();
    for (int j = 0; j < 3; ++j) {
      point[j] = centre_[j];
      for (int i = 0; i < 3; ++i) {
        point[j] += ((number >> i & 1) != 0 ? 1 : -1) * double{half_[i]} * axes_[i][j];
      }
    }
    return point;
  }

  Vector3 axis(int i) const { return {axes_[i][0], axes_[i][1], axes_[i][2]}; }
  /// Half of its length along an axis.
  Real half(int i) const { return half_[i]; }
  /// The axes along which the box is longest and second longest.
  std::pair<int, int> longestAxes() const {
    const int shortest =
        half_[0] < half_[1] ? (half_[0] < half_[2] ? 0 : 2) : (half_[1] < half_[2] ? 1 : 2);
    const int a = (shortest + 1) % 3, b = (shortest + 2) % 3;
    return half_[a] < half_[b] ? std::pair(b, a) : std::pair(a, b);
  }

  /// The area of the largest face, and of three faces that meet in a corner.
  double largestFace() const {
    const auto [a, b] = longestAxes();
    return 4. * half_[a] * half_[b];
  }
  double halfArea() const {
    return 4. * half_[0] * half_[1] + 4. * half_[1] * half_[2] + 4. * half_[2] * half_[0];
  }

  /// Widens the box, so that it holds boxes whose corners it was made around. A box is what its
  /// axes as they were rounded bound, and may reach beyond its corners by this part of its size.
  void widenForRoundedAxes() {
    const double reach = std::sqrt(double{half_[0]} * half_[0] + double{half_[1]} * half_[1] +
                                   double{half_[2]} * half_[2]);
    for (Real& half : half_) {
      half = static_cast<Real>(half + (1 - kNearlyOne) * 2 * reach);
    }
  }

  /// A lower bound of the squared distance of the box from a point.
  double squaredDistance(const Vector3& point) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double beyond = std::max(0., std::abs(coordinate(i, point)) - half_[i]);
      sum += beyond * beyond;
    }
    return sum * kNearlyOne;
  }

  /// A lower bound of the squared distance of the box from the point `away`, less that of the
  /// origin from it, without the cancellation of the two.
  double squaredDistanceLess(const Vector3& away) const {
    double sum = 0, reach = 0;
    for (int i = 0; i < 3; ++i) {
      const double towards = axes_[i][0] * away[0] + axes_[i][1] * away[1] + axes_[i][2] * away[2];
      const double middle = -coordinate(i, Vector3::Zero());
      const double nearest = std::clamp(towards, middle - half_[i], middle + half_[i]);
      sum += nearest * (nearest - 2 * towards);
      reach += std::abs(middle) + half_[i];
    }
    return sum - (1 - kNearlyOne) * reach * (reach + 2 * away.norm());
  }

  /// Whether the ray meets the box, widened by `margin` (1e-13 of a diagonal), between the
  /// distances `from` and `to`. Raises `from` to where the ray enters.
  bool meets(const Ray& ray, double margin, double& from, double to) const {
    for (int i = 0; i < 3; ++i) {
      const double start = coordinate(i, ray.origin);
      const double rate = axes_[i][0] * ray.direction[0] + axes_[i][1] * ray.direction[1] +
                          axes_[i][2] * ray.direction[2];
      const double half = half_[i] + margin;
      if (std::abs(rate) < kParallel) {
        // Over a diagonal, as far as the surface reaches, the ray moves along this axis by 1e-12 of
        // that, which is ten margins: twice that is allowed.
        if (std::abs(start) > half + 20 * margin) {
          return false;
        }
        continue;
      }
      const double inverse = 1 / rate;
      const double a = (-half - start) * inverse, b = (half - start) * inverse;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from <= to;
  }

 private:
  /// A ray counts as perpendicular to an axis if the cosine of their angle is below this.
  static constexpr double kParallel = 1e-12;
  /// Axes in single precision are orthonormal to 3e-7, those in double precision to 1e-15.
  static constexpr double kNearlyOne =
      std::numeric_limits<Real>::digits < 53 ? 1 - 1e-6 : 1 - 1e-14;

  double coordinate(int i, const Vector3& point) const {
    return axes_[i][0] * (point[0] - centre_[0]) + axes_[i][1] * (point[1] - centre_[1]) +
           axes_[i][2] * (point[2] - centre_[2]);
  }

  /// Sets the centre and the axes, the rows of `frame`.
  void place(const Vector3& centre, const Eigen::Matrix3d& frame);

  Real centre_[3], axes_[3][3], half_[3];
};

/// The boxes of leaves.
using LeafBox = OrientedBox<float>;
/// Boxes that are exact also far below the rounding of single precision.
using CoreBox = OrientedBox<double>;

}  // namespace limitsurf
