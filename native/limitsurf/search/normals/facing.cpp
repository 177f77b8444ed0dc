// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/facing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/surface/differential.h"

namespace limitsurf {
namespace {

/// If the sine of the angle between the tangents is below this, rounding may turn their cross
/// product too far, and the normal that evaluate() gives decides.
constexpr double kParallel = 1e-3;
/// Nor may the cross product nearly vanish beside the patch's size, as next to a fold, where
/// evaluate() gives no normal. Its measure of size is less than this many times ours.
constexpr double kLargerSize = 64;
/// The cross products of tangents of a patch that is collapsed onto a line are at most this part of
/// the square of the longest tangent: 64 roundings. There evaluate() gives no normal.
constexpr double kLine = 0x1p-46;
/// On a patch whose sides are shorter than this part of a face, (u, v) near 1 has so few digits
/// that the location of a place may be another place, which has another normal at the tip of a
/// cone.
constexpr double kSmall = 0x1p-40;

/// The largest distance of a control point from the first one.
double sizeOf(const BezierPatch& patch) {
  double square = 0;
  for (const BezierPatch::Point& point : patch.points) {
    square = std::max(square, (point - patch.points[0]).head<3>().square().sum());
  }
  return std::sqrt(square);
}

}  // namespace

bool Facing::accepts(const BezierPatch& patch, double s, double t, const Vector3& ds,
                     const Vector3& dt) const {
  const Location at = patch.on.at(s, t);
  if (patch.on.width() < kSmall) {
    return accepts(at);
  }
  // A patch has the orientation of its face, up to rotations by right angles.
  const Vector3 normal = ds.cross(dt);
  const bool is_certain = normal.norm() > kParallel * ds.norm() * dt.norm() &&
                          isWellConditioned(ds, dt, kLargerSize * sizeOf(patch));
  return is_certain ? accepts(normal) : accepts(at);
}

bool Facing::excludesLine(const BezierPatch& patch) const {
  if (least_cosine < -1) {
    return false;
  }
  const BezierPatch::Point* p = patch.points;
  double longest = 0, largest = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Vector3 ds = (p[4 * j + i + 1] - p[4 * j + i]).head<3>();
      longest = std::max(longest, ds.squaredNorm());
      for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 3; ++y) {
          const Vector3 dt = (p[4 * (y + 1) + x] - p[4 * y + x]).head<3>();
          longest = std::max(longest, dt.squaredNorm());
          largest = std::max(largest, ds.cross(dt).squaredNorm());
        }
      }
    }
  }
  return largest <= kLine * kLine * longest * longest;
}

bool Facing::excludes(const BezierPatch& patch) const {
  // Normals are sums of cross products of differences of control points.
  if (!(least_cosine > 0)) {
    return false;
  }
  const BezierPatch::Point* p = patch.points;
  bool any = false;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Vector3 ds = (p[4 * j + i + 1] - p[4 * j + i]).head<3>();
      const Vector3 across = direction.cross(ds);
      for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 3; ++y) {
          const BezierPatch::Point dt = p[4 * (y + 1) + x] - p[4 * y + x];
          const double towards = across[0] * dt[0] + across[1] * dt[1] + across[2] * dt[2];
          if (towards > 0) {
            return false;
          }
          any |= towards < 0 || (ds != Vector3::Zero() && (dt != 0).any());
        }
      }
    }
  }
  return any;
}

}  // namespace limitsurf
