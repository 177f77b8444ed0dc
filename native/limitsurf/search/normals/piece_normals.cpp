// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/piece_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/interruption_point.h"
#include "limitsurf/pi.h"
#include "limitsurf/search/normals/facing.h"

namespace limitsurf {
namespace {

using Border = PieceNormals::Border;

/// More than the rounding of a cosine.
constexpr double kCosineRounding = 1e-14;
/// A place counts as a local minimum if the distance falls by a slope of at most this: more than
/// kFlatSlope.
constexpr double kSlope = 2 * DirectionCone::kMargin;

/// The sides of a piece at which the surface ends.
class Borders {
 public:
  /// Adds those of a patch. Each begins at the parameter `begin`.
  void include(const BezierPatch& patch, double begin) {
    for (const unsigned side : {kSideS0, kSideS1, kSideT0, kSideT1}) {
      if (patch.borders & side) {
        const DirectionCone cone = sideCone(patch, side, begin);
        along_ = any_ ? DirectionCone::around(along_, cone) : cone;
        any_ = true;
      }
    }
  }
  void setOn(PieceNormals& piece) const {
    piece.border = !any_ ? Border::none : along_.isEverything() ? Border::unknown : Border::smooth;
    piece.along_border = along_;
  }

 private:
  bool any_ = false;
  DirectionCone along_;
};

bool isCorner(unsigned sides) {
  return (sides & (kSideS0 | kSideS1)) != 0 && (sides & (kSideT0 | kSideT1)) != 0;
}

PieceNormals ofPatch(const BezierPatch& patch) {
  PieceNormals piece;
  piece.normals = normalCone(patch);
  if (piece.normals.isEverything() || isCorner(patch.borders)) {
    piece.border = Border::unknown;
  } else {
    Borders borders;
    borders.include(patch, 0);
    borders.setOn(piece);
  }
  return piece;
}

/// The cone of all normals that a search finds on a core, down to its vertex.
DirectionCone coneOfCore(const SearchTree& tree, SurfacePiece core) {
  DirectionCone cone;
  cone.axis = frameNormal(tree.surface, tree.patches.rectangle(core).at(0, 0));
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  do {
    stride.step();
    tree.patches.splitPatches(core, split);
    for (const BezierPatch& patch : split.patches) {
      cone = DirectionCone::around(cone, normalCone(patch));
    }
    core = split.core;
  } while (!cone.isEverything() && tree.patches.coreRadius(core) > tree.tolerance &&
           core.steps < SurfacePatches::kMostSteps);
  return cone;
}

/// The cone of all normals on the cores around a vertex.
DirectionCone coneOfRing(const SearchTree& tree, const SurfacePiece& first) {
  DirectionCone cone = coneOfCore(tree, first);
  const int ring = tree.patches.ringOf(first), level = tree.patches.ringLevel(first);
  for (int i = 1; i < tree.rings.coreCount(ring) && !cone.isEverything(); ++i) {
    cone = DirectionCone::around(cone, coneOfCore(tree, tree.rings.core(ring, i, level)));
  }
  return cone;
}

/// What is known of the borders of a core.
void setBorder(const SearchTree& tree, const SurfacePiece& core, PieceNormals& piece) {
  piece.border = Border::unknown;
  const Location vertex = tree.patches.rectangle(core).at(0, 0);
  if (piece.normals.isEverything() ||
      !tree.surface.evaluate({&vertex, 1}, Derivatives::first, true, 1).normal.allFinite()) {
    return;
  }
  SurfacePatches::SplitCore split;
  tree.patches.splitPatches(core, split);
  constexpr unsigned kFromVertex[3] = {kSideT0, 0, kSideS0};
  Borders borders;
  bool any = false;
  for (int quarter = 0; quarter < 3; ++quarter) {
    const BezierPatch& patch = split.patches[quarter];
    if ((patch.borders & ~kFromVertex[quarter]) != 0) {
      return;
    }
    // A side that leaves the vertex is one cubic, of which the patch has the half farther away.
    borders.include(patch, -1);
    any = any || patch.borders != 0;
  }
  if (!any || tree.patches.isOnBoundaryCurve(core)) {
    borders.setOn(piece);
  }
}

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

PieceNormals normalsOfLeaf(const SearchTree& tree, const SurfacePiece& leaf) {
  if (!leaf.isCore()) {
    return ofPatch(tree.patches.patch(leaf));
  }
  if (tree.rings.isLarge(tree.patches.ringOf(leaf))) {
    PieceNormals piece;
    piece.normals = coneOfRing(tree, leaf);
    piece.border = Border::unknown;
    return piece;
  }
  PieceNormals piece;
  piece.normals = coneOfCore(tree, leaf);
  setBorder(tree, leaf, piece);
  return piece;
}

}  // namespace limitsurf
