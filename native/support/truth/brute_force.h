// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

/// A ray in long double; the direction is a unit vector.
struct LongRay {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  LongRay(const Vector3& from, const Vector3& to);

  /// The distance along the ray to its point nearest to `point`, and the distance of `point` from
  /// that.
  std::pair<long double, long double> alongAndAside(const Vector3& point) const;

  Vector origin, direction;
};

/// Nearest points and hits of rays by dense samples of LimitSurface::evaluate() and refinement of
/// the best of them, with distances in long double. Everything that it finds exists, but it may
/// miss some.
class BruteForce {
 public:
  /// per_side x per_side cells on each Ptex face that has a surface.
  BruteForce(const LimitSurface& surface, int per_side);

  struct Foot {
    long double distance;
    Location at;
  };
  Foot closest(const Vector3& point) const { return nearest(point, 8, {}); }
  /// The closest of all local minima on the faces that `accepts` accepts.
  Foot closest(const Vector3& point, const std::function<bool(const Location&)>& accepts) const {
    return nearest(point, 1 << 20, accepts);
  }

  struct Root {
    Location at;
    Vector3 position;
    long double distance;  ///< along the ray
    double sine;           ///< of the angle between ray and surface
  };
  /// Places where the line of the ray crosses the surface, behind its origin too, sorted; each
  /// once, also where faces meet. Those at which it only touches are left out.
  std::vector<Root> roots(const LongRay& ray) const;

  const LimitSurface& surface() const { return surface_; }
  /// The diagonal of the control mesh's bounding box.
  double diagonal() const { return diagonal_; }

 private:
  Foot nearest(const Vector3& point, int most_starts,
               const std::function<bool(const Location&)>& accepts) const;
  /// The local minimum that is found from a location, by steps from `step` down to `smallest`.
  Foot refined(const Vector3& point, Location at, double step, double smallest) const;
  Location at(std::size_t face, int i, int j) const;
  std::size_t index(std::size_t face, int i, int j) const;

  const LimitSurface& surface_;
  int per_side_;
  double diagonal_;
  std::vector<int> faces_;
  Points samples_;
};

/// Distance in long double.
long double distanceBetween(const Vector3& a, const Vector3& b);

}  // namespace limitsurf::test
