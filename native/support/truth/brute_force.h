// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>
#include <utility>
#include <vector>

#include "limitsurf/precision/double_double_eigen.h"
#include "support/cages/cage.h"

namespace limitsurf {

/// What GoogleTest prints.
inline void PrintTo(const DoubleDouble& number, std::ostream* out) {
  *out << number.high() << " + " << number.low();
}

}  // namespace limitsurf

namespace limitsurf::test {

/// A ray in double-doubles; the direction is a unit vector.
struct WideRay {
  using Vector = Eigen::Matrix<DoubleDouble, 3, 1>;
  WideRay(const Vector3& from, const Vector3& to);

  /// The distance along the ray to its point nearest to `point`, and the distance of `point` from
  /// that.
  std::pair<DoubleDouble, DoubleDouble> alongAndAside(const Vector3& point) const;

  Vector origin, direction;
};

/// Nearest points and hits of rays by dense samples of LimitSurface::evaluate() and refinement of
/// the best of them, with distances in double-doubles. Everything that it finds exists, but it may
/// miss some.
class BruteForce {
 public:
  /// per_side x per_side cells on each Ptex face that has a surface.
  BruteForce(const LimitSurface& surface, int per_side);

  struct Foot {
    DoubleDouble distance;
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
    DoubleDouble distance;  ///< along the ray
    double sine;            ///< of the angle between ray and surface
  };
  /// Places where the line of the ray crosses the surface, behind its origin too, sorted; each
  /// once, also where faces meet. Those at which it only touches are left out.
  std::vector<Root> roots(const WideRay& ray) const;

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

/// Distance in double-doubles.
DoubleDouble distanceBetween(const Vector3& a, const Vector3& b);

}  // namespace limitsurf::test
