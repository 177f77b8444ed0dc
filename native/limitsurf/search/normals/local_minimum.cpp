// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/local_minimum.h"

#include <cmath>

namespace limitsurf {
namespace {

/// The rounding of a tangent of a patch, relative to its length: more than that of the three
/// differences and interpolations that it is made of.
constexpr double kTangentRounding = 1e-14;
/// The rounding of second derivatives, of the tolerance: 24 times that of Bezier points, of 2e-17
/// of the diagonal.
constexpr double kSecondRounding = 0.005;

/// A direction of the sheet, in which it goes on both ways if `inwards` is 0.
struct Direction {
  Vector3 unit = Vector3::Zero();
  double inwards = 0;
  double rounding = 0;  ///< of `unit`
};

Direction along(const Vector3& tangent, double inwards) {
  const double length = tangent.norm();
  return length > 0 ? Direction{tangent / length, inwards, kTangentRounding} : Direction{};
}

/// The part of a tangent that is perpendicular to another direction.
Direction across(const Vector3& tangent, double inwards, const Direction& other) {
  const Vector3 part = tangent - tangent.dot(other.unit) * other.unit;
  Direction direction = along(part, inwards);
  if (direction.rounding > 0) {
    direction.rounding *= tangent.norm() / part.norm();
  }
  return direction;
}

/// How the distance slopes in a direction.
struct Slope {
  Slope(const Direction& direction, const Vector3& offset, double tolerance) {
    const double slope = offset.dot(direction.unit);
    const double least = (kFlatSlope + direction.rounding) * offset.norm() + tolerance;
    falls = (direction.inwards == 0 ? std::abs(slope) : -direction.inwards * slope) > least;
    is_flat = std::abs(slope) <= least;
  }
  bool falls, is_flat;
};

/// The second derivatives of half the squared distance, in parameters whose tangents have length 1.
struct Bending {
  Bending(const BezierPatch::Values& at, const Vector3& offset, double tolerance) {
    const BezierPatch::Point way(offset[0], offset[1], offset[2], 0);
    const double e = dot(at.ds, at.ds), g = dot(at.dt, at.dt), f = std::sqrt(e * g);
    const auto length = [](const BezierPatch::Point& p) { return std::sqrt(dot(p, p)); };
    ss = 1 + dot(way, at.dss) / e;
    tt = 1 + dot(way, at.dtt) / g;
    st = (dot(at.ds, at.dt) + dot(way, at.dst)) / f;
    // A slope that counts as none may turn second derivatives by as much as it is.
    const double second = length(at.dss) / e + 2 * length(at.dst) / f + length(at.dtt) / g;
    least = -kFlatSlope - offset.norm() * (kFlatSlope * second +
                                           kSecondRounding * tolerance * (1 / e + 2 / f + 1 / g));
  }
  bool fallsAlongS() const { return ss < least; }
  bool fallsAlongT() const { return tt < least; }
  bool fallsAnywhere() const {
    return fallsAlongS() || fallsAlongT() || (ss - least) * (tt - least) < st * st;
  }

  double ss, tt, st;
  double least;  ///< what counts as negative is less than this
};

}  // namespace

bool isLocalMinimum(const SheetPlace& place, const Vector3& offset, double tolerance) {
  const Vector3 ds = place.at.ds.head<3>(), dt = place.at.dt.head<3>();
  const bool s_ends = place.s_inwards != 0, t_ends = place.t_inwards != 0;
  // A sheet that ends along dt goes on in all directions on one side of dt.
  const Direction first = s_ends && !t_ends ? along(dt, 0) : along(ds, place.s_inwards);
  const Direction second = s_ends && t_ends ? along(dt, place.t_inwards)
                           : s_ends         ? across(ds, place.s_inwards, first)
                                            : across(dt, place.t_inwards, first);
  const Slope a(first, offset, tolerance), b(second, offset, tolerance);
  if (a.falls || b.falls) {
    return false;
  }
  const Bending bending(place.at, offset, tolerance);
  if (s_ends && t_ends) {
    return !((a.is_flat && bending.fallsAlongS()) || (b.is_flat && bending.fallsAlongT()));
  }
  if ((s_ends || t_ends) && !b.is_flat) {
    return !(s_ends ? bending.fallsAlongT() : bending.fallsAlongS());
  }
  return !bending.fallsAnywhere();
}

}  // namespace limitsurf
