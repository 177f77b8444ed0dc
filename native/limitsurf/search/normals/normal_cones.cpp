// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/normal_cones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/parallel.h"
#include "limitsurf/pi.h"
#include "limitsurf/search/normals/facing.h"
#include "limitsurf/search/normals/normal_polynomial.h"

namespace limitsurf {
namespace {

/// More than the rounding of the angles of cones, and of the search's own test of normals.
constexpr double kMargin = 1e-7;
/// If the sine of the angle between two tangents of a patch may be smaller, nothing is known of its
/// normals: there the search asks for the surface's frame.
constexpr double kLeastSine = 0.01;
/// More than the rounding of a cosine.
constexpr double kCosineRounding = 1e-14;
/// More than the rounding of boxes and of places in them, in the unit of boxes.
constexpr double kLeastRadius = 1e-6;
/// Wider cones are worth the effort of making them narrower.
constexpr double kNarrow = 0.5;
/// The axes of two cones count as parallel if the sine of their angle is at most this: then the
/// rounding of the direction from one to the other would exceed kMargin.
constexpr double kLeastTurn = 1e-8;
/// The number of leaves that one task looks at.
constexpr std::size_t kLeavesPerTask = 64;

double angleBetween(const Vector3& a, const Vector3& b) {
  // Exact for small angles, too.
  return 2 * std::atan2((a - b).norm(), (a + b).norm());
}

/// A mean direction of vectors, and the largest distance of one of them from it, all of them with
/// unit length. Returns false if one of them is 0.
bool spread(const Vector3 (&vectors)[12], Vector3& middle, double& farthest) {
  Vector3 units[12];
  middle.setZero();
  for (int i = 0; i < 12; ++i) {
    const double length = vectors[i].norm();
    if (!(length > 0)) {
      return false;
    }
    units[i] = vectors[i] / length;
    middle += units[i];
  }
  middle.normalize();
  farthest = 0;
  for (const Vector3& unit : units) {
    farthest = std::max(farthest, (unit - middle).norm());
  }
  return true;
}

/// A cone around the Bernstein coefficients of the normal. It costs ten times as much as spread(),
/// and is narrow also where the tangents turn, or are nearly parallel, as at the smooth corner of a
/// single face.
NormalCone coneOfCoefficients(const BezierPatch& patch) {
  const NormalPolynomial::Cone cone = NormalPolynomial(patch, 0).cone({0, 0, 1, 1});
  const double angle = std::atan(cone.tangent);
  // A cone of half a turn and more is not convex, and bounds no sums of its vectors.
  return angle < kPi<double> / 2 - kMargin
             ? NormalCone{Vector3(cone.axis.head<3>()), angle + kMargin}
             : NormalCone::everything();
}

/// The cone of all normals that a search finds on a core, down to its vertex.
NormalCone coneOfCore(const SearchTree& tree, SurfacePiece core) {
  NormalCone cone;
  cone.axis = frameNormal(tree.surface, tree.patches.rectangle(core).at(0, 0));
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  do {
    stride.step();
    tree.patches.splitPatches(core, split);
    for (const BezierPatch& patch : split.patches) {
      cone = NormalCone::around(cone, normalCone(patch));
    }
    core = split.core;
  } while (cone.angle < kPi<double> && tree.patches.coreRadius(core) > tree.tolerance &&
           core.steps < SurfacePatches::kMostSteps);
  return cone;
}

/// The cone of all normals on the cores around a vertex.
NormalCone coneOfRing(const SearchTree& tree, const SurfacePiece& first) {
  NormalCone cone = coneOfCore(tree, first);
  const int ring = tree.patches.ringOf(first), level = tree.patches.ringLevel(first);
  for (int i = 1; i < tree.rings.coreCount(ring) && cone.angle < kPi<double>; ++i) {
    cone = NormalCone::around(cone, coneOfCore(tree, tree.rings.core(ring, i, level)));
  }
  return cone;
}

/// Whether a core has no side at which the surface ends, and a normal at its vertex.
bool isSmooth(const SearchTree& tree, const SurfacePiece& core) {
  SurfacePatches::SplitCore split;
  tree.patches.splitPatches(core, split);
  for (const BezierPatch& patch : split.patches) {
    if (patch.borders != 0) {
      return false;
    }
  }
  const Location vertex = tree.patches.rectangle(core).at(0, 0);
  return tree.surface.evaluate({&vertex, 1}, Derivatives::first, true, 1).normal.allFinite();
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

}  // namespace

NormalCone NormalCone::everything() { return {Vector3::UnitZ(), kPi<double>}; }

NormalCone NormalCone::around(const NormalCone& a, const NormalCone& b) {
  const NormalCone& wide = a.angle < b.angle ? b : a;
  const NormalCone& narrow = a.angle < b.angle ? a : b;
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
    return apart < 1 ? NormalCone{wide.axis, apart + narrow.angle + kMargin} : everything();
  }
  return {(std::cos(turn) * wide.axis + std::sin(turn) / length * across).normalized(),
          angle + kMargin};
}

bool NormalCone::isBeyond(const Vector3& direction, double reach) const {
  return angleBetween(axis, direction) > angle + reach + kMargin;
}

NormalCone normalCone(const BezierPatch& patch) {
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
  const NormalCone cone{normal / sine, std::asin(off / sine) + kMargin};
  if (cone.angle < kNarrow) {
    return cone;
  }
  const NormalCone other = coneOfCoefficients(patch);
  return other.angle < cone.angle ? other : cone;
}

bool NormalCones::cannotFace(std::int32_t node, int child, const Vector3& point,
                             const Vector3& direction, double angle) const {
  const Normals& normals = children_[place(node, child)];
  if (normals.cone.isBeyond(direction, angle)) {
    return true;
  }
  if (!normals.is_smooth) {
    return false;
  }
  Vector3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = tree_.node(node).bounds[axis][0][child];
    high[axis] = tree_.node(node).bounds[axis][1][child];
  }
  const Vector3 way = (low + high) / 2 - point;
  const double radius = (high - low).norm() / 2 + kLeastRadius;
  return !mayLeadAlong(direction, way, radius, angle + kMargin) ||
         !mayLeadAlong(normals.cone.axis, way, radius, normals.cone.angle + kMargin);
}

NormalCones::Normals NormalCones::ofLeaf(const SearchTree& tree, const SurfacePiece& leaf) {
  if (!leaf.isCore()) {
    const BezierPatch patch = tree.patches.patch(leaf);
    const NormalCone cone = normalCone(patch);
    return {cone, patch.borders == 0 && cone.angle < kPi<double>};
  }
  if (tree.rings.isLarge(tree.patches.ringOf(leaf))) {
    return {coneOfRing(tree, leaf), false};
  }
  const NormalCone cone = coneOfCore(tree, leaf);
  return {cone, cone.angle < kPi<double> && isSmooth(tree, leaf)};
}

NormalCones::NormalCones(const SearchTree& tree, int threads) : tree_(*tree.tree) {
  std::vector<Normals> leaves(tree.leaves.size());
  parallelFor(leaves.size(), kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      leaves[leaf] = ofLeaf(tree, tree.leaves[leaf].piece);
    }
  });
  const std::int32_t count = tree_.nodeCount();
  children_.resize(WideTree::kWidth * static_cast<std::size_t>(count));
  // Children have higher numbers than their parents.
  for (std::int32_t number = count - 1; number >= 0; --number) {
    const WideTree::Node& node = tree_.node(number);
    for (int i = 0; i < node.count; ++i) {
      const std::int32_t child = node.children[i];
      children_[place(number, i)] = WideTree::isLeaf(child)
                                        ? leaves[static_cast<std::size_t>(WideTree::leaf(child))]
                                        : together(child, tree_.node(child).count);
    }
  }
}

NormalCones::Normals NormalCones::together(std::int32_t node, int count) const {
  Normals all = children_[place(node, 0)];
  for (int i = 1; i < count; ++i) {
    const Normals& child = children_[place(node, i)];
    all.cone = NormalCone::around(all.cone, child.cone);
    all.is_smooth = all.is_smooth && child.is_smooth;
  }
  return all;
}

}  // namespace limitsurf
