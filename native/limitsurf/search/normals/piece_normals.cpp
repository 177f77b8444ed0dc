// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/piece_normals.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/pi.h"

namespace limitsurf {
namespace {

using Border = PieceNormals::Border;

/// More than the rounding of a cosine.
constexpr double kCosineRounding = 1e-14;
/// A place counts as a local minimum if the distance falls by a slope of at most this: more than
/// kFlatSlope.
constexpr double kSlope = 2 * DirectionCone::kMargin;

/// Whether the way from a point to some place of a sphere, or from there to the point, may be
/// within `angle` of a direction. `way` leads from the point to the middle of the sphere.
bool mayLeadAlong(const Vector3& direction, const Vector3& way, double radius, double angle) {
  const double distance = way.norm();
  if (!(radius < distance) || angle >= kPi<double> / 2) {
    return true;
  }
  // The cosine of the angle plus that between the middle and the rim of the sphere.
  const double sine = radius / distance;
  const double least = std::cos(angle) * std::sqrt(1 - sine * sine) - std::sin(angle) * sine;
  return std::abs(way.dot(direction)) >= (least - kCosineRounding) * distance;
}

/// Whether the distance may have a local minimum at a place of a border in some sphere: whether the
/// way to the place may be perpendicular to the border, and lead into the surface.
bool mayEndAt(const PieceNormals& piece, const Vector3& way, double radius) {
  const double distance = way.norm();
  if (!(radius < distance)) {
    return true;
  }
  // What is added to the parts of the way along two directions, which turn by these angles at most.
  const double slack = radius + kSlope * (distance + radius);
  const Vector3& along = piece.along_border.axis;
  if (std::abs(way.dot(along)) > distance * piece.along_border.angle + slack) {
    return false;
  }
  const Vector3 inwards = piece.normals.axis.cross(along);
  return way.dot(inwards) >= -(distance * (piece.along_border.angle + piece.normals.angle) + slack);
}

}  // namespace

PieceNormals PieceNormals::around(const PieceNormals& a, const PieceNormals& b) {
  PieceNormals both;
  both.normals = DirectionCone::around(a.normals, b.normals);
  if (both.normals.isEverything() || a.border == Border::unknown || b.border == Border::unknown) {
    both.border = Border::unknown;
  } else if (a.border == Border::smooth && b.border == Border::smooth) {
    both.along_border = DirectionCone::around(a.along_border, b.along_border);
    both.border = both.along_border.isEverything() ? Border::unknown : Border::smooth;
  } else if (a.border == Border::smooth || b.border == Border::smooth) {
    both.along_border = a.border == Border::smooth ? a.along_border : b.along_border;
    both.border = Border::smooth;
  }
  return both;
}

bool PieceNormals::cannotFace(const Vector3& direction, double angle, const Vector3& way,
                              double radius) const {
  if (normals.isBeyond(direction, angle)) {
    return true;
  }
  if (border == Border::unknown ||
      (mayLeadAlong(direction, way, radius, angle + DirectionCone::kMargin) &&
       mayLeadAlong(normals.axis, way, radius, normals.angle + DirectionCone::kMargin))) {
    return false;
  }
  return border == Border::none || !mayEndAt(*this, way, radius);
}

}  // namespace limitsurf
