// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/direction_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/pi.h"
#include "limitsurf/search/normals/normal_polynomial.h"

namespace limitsurf {
namespace {

constexpr double kMargin = DirectionCone::kMargin;
/// If the sine of the angle between two tangents of a patch may be smaller, nothing is known of its
/// normals: there the search asks for the surface's frame.
constexpr double kLeastSine = 0.01;
/// Wider cones are worth the effort of making them narrower.
constexpr double kNarrow = 0.5;
/// The axes of two cones count as parallel if the sine of their angle is at most this: then the
/// rounding of the direction from one to the other would exceed kMargin.
constexpr double kLeastTurn = 1e-8;

double angleBetween(const Vector3& a, const Vector3& b) {
  // Exact for small angles, too.
  return 2 * std::atan2((a - b).norm(), (a + b).norm());
}

/// A mean direction of vectors, and the largest distance of one of them from it, all of them with
/// unit length. Returns false if one of them is 0.
template <int count>
bool spread(Vector3 (&vectors)[count], Vector3& middle, double& farthest) {
  middle.setZero();
  for (Vector3& vector : vectors) {
    const double length = vector.norm();
    if (!(length > 0)) {
      return false;
    }
    vector /= length;
    middle += vector;
  }
  middle.normalize();
  farthest = 0;
  for (const Vector3& unit : vectors) {
    farthest = std::max(farthest, (unit - middle).norm());
  }
  return true;
}

/// A cone around the Bernstein coefficients of the normal. It costs ten times as much as spread(),
/// and is narrow also where the tangents turn, or are nearly parallel, as at the smooth corner of a
/// single face.
DirectionCone coneOfCoefficients(const BezierPatch& patch) {
  const NormalPolynomial::Cone cone = NormalPolynomial(patch, 0).cone({0, 0, 1, 1});
  const double angle = std::atan(cone.tangent);
  // A cone of half a turn and more is not convex, and bounds no sums of its vectors.
  return angle < kPi<double> / 2 - kMargin
             ? DirectionCone{Vector3(cone.axis.head<3>()), angle + kMargin}
             : DirectionCone::everything();
}

}  // namespace

DirectionCone DirectionCone::everything() { return {Vector3::UnitZ(), kPi<double>}; }

DirectionCone DirectionCone::around(const DirectionCone& a, const DirectionCone& b) {
  const DirectionCone& wide = a.angle < b.angle ? b : a;
  const DirectionCone& narrow = a.angle < b.angle ? a : b;
  const double apart = angleBetween(wide.axis, narrow.axis);
  if (!(apart + narrow.angle > wide.angle)) {
    return wide;
  }
  const double angle = (wide.angle + apart + narrow.angle) / 2 + kMargin;
  if (!(angle < kPi<double>)) {
    return everything();
  }
  // The axis is turned towards the narrow one's.
  const Vector3 across = narrow.axis - wide.axis.dot(narrow.axis) * wide.axis;
  const double length = across.norm(), turn = angle - wide.angle;
  if (!(length > kLeastTurn)) {
    // Rounding decides where `across` points. Axes that are opposite have no direction in between.
    return apart < 1 ? DirectionCone{wide.axis, apart + narrow.angle + kMargin} : everything();
  }
  return {(std::cos(turn) * wide.axis + std::sin(turn) / length * across).normalized(),
          angle + kMargin};
}

bool DirectionCone::isEverything() const { return !(angle < kPi<double>); }

bool DirectionCone::isBeyond(const Vector3& direction, double reach) const {
  return angleBetween(axis, direction) > angle + reach + kMargin;
}

DirectionCone normalCone(const BezierPatch& patch) {
  // The derivatives are means of differences of control points, with positive weights.
  Vector3 along_s[12], along_t[12];
  const BezierPatch::Point* p = patch.points;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      along_s[3 * j + i] = (p[4 * j + i + 1] - p[4 * j + i]).head<3>();
      along_t[3 * j + i] = (p[4 * (i + 1) + j] - p[4 * i + j]).head<3>();
    }
  }
  Vector3 s, t;
  double off_s, off_t;
  if (!spread(along_s, s, off_s) || !spread(along_t, t, off_t)) {
    return coneOfCoefficients(patch);
  }
  // (s + a) x (t + b) differs from s x t by less than this.
  const double off = off_s + off_t + off_s * off_t;
  const Vector3 normal = s.cross(t);
  const double sine = normal.norm();
  if (!(off + kLeastSine < sine)) {
    return coneOfCoefficients(patch);
  }
  // Normals are means of u x v, for differences u and v of unit length. Such a product rises along
  // the axis by sine - off at least, and aside by no more than u and v lie off the plane.
  const Vector3 axis = normal / sine;
  double off_plane_s = 0, off_plane_t = 0;
  for (int i = 0; i < 12; ++i) {
    off_plane_s = std::max(off_plane_s, std::abs(axis.dot(along_s[i])));
    off_plane_t = std::max(off_plane_t, std::abs(axis.dot(along_t[i])));
  }
  const double tangent = (off_plane_s + off_plane_t) / (sine - off);
  DirectionCone cone{axis, std::atan(tangent) + kMargin};
  if (cone.angle < kNarrow) {
    return cone;
  }
  const DirectionCone other = coneOfCoefficients(patch);
  return other.angle < cone.angle ? other : cone;
}

DirectionCone sideCone(const BezierPatch& patch, unsigned side, double begin) {
  const bool along_s = (side & (kSideT0 | kSideT1)) != 0;
  const int first = side == kSideS1 ? 3 : side == kSideT1 ? 12 : 0, stride = along_s ? 1 : 4;
  const double sign = side == kSideT0 || side == kSideS1 ? 1 : -1;
  Vector3 d[3];
  for (int i = 0; i < 3; ++i) {
    const BezierPatch::Point* p = patch.points + first + stride * i;
    d[i] = sign * (p[stride] - p[0]).head<3>().matrix();
  }
  // The polar form of the derivative at (begin, begin), (begin, 1) and (1, 1).
  const double rest = 1 - begin;
  Vector3 tangents[3] = {rest * rest * d[0] + 2 * begin * rest * d[1] + begin * begin * d[2],
                         rest * d[1] + begin * d[2], d[2]};
  DirectionCone cone;
  if (!spread(tangents, cone.axis, cone.angle)) {
    return DirectionCone::everything();
  }
  // The spread is the length of a chord. Beyond a right angle directions have no cone.
  if (!(cone.angle < 1)) {
    return DirectionCone::everything();
  }
  cone.angle = 2 * std::asin(cone.angle / 2) + kMargin;
  return cone;
}

}  // namespace limitsurf
