// SPDX-License-Identifier: Apache-2.0
//
// Cones of normals contain what they were made of, and no local minimum of a distance is left out.
#include "limitsurf/search/normals/normal_cones.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "limitsurf/pi.h"
#include "limitsurf/surface/limit_surface.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

double angleBetween(const Vector3& a, const Vector3& b) {
  return 2 * std::atan2((a - b).norm(), (a + b).norm());
}

/// A direction at an angle from an axis.
Vector3 turned(const Vector3& axis, double angle, Random& random) {
  const Vector3 across = axis.cross(random.vector(1)).normalized();
  return std::cos(angle) * axis + std::sin(angle) * across;
}

/// Two cones whose axes are parallel or opposite but for little or nothing: their common cone has
/// a direction that rounding must not choose.
TEST(NormalCones, TheConeAroundTwoContainsBoth) {
  Random random(1);
  for (int round = 0; round < 4000; ++round) {
    DirectionCone a, b;
    a.axis = random.vector(1).normalized();
    a.angle = random.uniform(0, 1.5) * random.below(2);
    const double off = random.below(4) == 0 ? 0 : std::pow(10., random.uniform(-17, 0));
    b.axis = turned(random.below(2) == 0 ? a.axis : Vector3(-a.axis), off, random).normalized();
    b.angle = random.uniform(0, 1.5) * random.below(2);
    const DirectionCone both = DirectionCone::around(a, b);
    for (const DirectionCone& cone : {a, b}) {
      for (const double part : {0., 0.5, 1.}) {
        const Vector3 inside = turned(cone.axis, part * cone.angle, random);
        EXPECT_LE(angleBetween(both.axis, inside), both.angle + 1e-7) << off;
        EXPECT_FALSE(both.isBeyond(inside, 0));
      }
    }
  }
}

/// Also where the tangents of a patch turn far, or are nearly parallel.
TEST(NormalCones, OfAPatchContainsItsNormals) {
  Random random(2);
  int narrow = 0;
  for (int round = 0; round < 2000; ++round) {
    BezierPatch patch;
    patch.anchor.setZero();
    const double skew = random.below(2) == 0 ? 0 : 1 - std::pow(10., random.uniform(-6, 0));
    const double noise = std::pow(10., random.uniform(-8, 0));
    for (int i = 0; i < 16; ++i) {
      const double s = i % 4 / 3., t = i / 4 / 3.;
      const Vector3 bump = random.vector(noise * (1 - skew));
      patch.points[i] = {s - skew * t + bump[0], (1 - skew) * t + bump[1], bump[2], 0};
    }
    const DirectionCone cone = normalCone(patch);
    narrow += cone.angle < 1;
    for (int place = 0; place < 20; ++place) {
      BezierPatch::Values at;
      patch.evaluate<1>(random.uniform(), random.uniform(), at);
      const Vector3 normal = Vector3(at.ds.head<3>()).cross(Vector3(at.dt.head<3>())).normalized();
      EXPECT_FALSE(cone.isBeyond(normal, 0)) << skew << ", " << noise;
    }
  }
  EXPECT_GT(narrow, 1000);
}

TEST(NormalCones, OfASideContainsItsDirectionsBeyondThePatch) {
  Random random(3);
  for (int round = 0; round < 500; ++round) {
    BezierPatch patch;
    patch.anchor.setZero();
    for (int i = 0; i < 16; ++i) {
      const Vector3 bump = random.vector(0.01);
      patch.points[i] = {i % 4 / 3. + bump[0], i / 4 / 3. + bump[1], bump[2], 0};
    }
    const double begin = random.below(2) == 0 ? 0 : -1;
    for (const unsigned side : {kSideS0, kSideS1, kSideT0, kSideT1}) {
      const DirectionCone cone = sideCone(patch, side, begin);
      EXPECT_LT(cone.angle, 1);
      for (int place = 0; place < 10; ++place) {
        const double x = random.uniform(begin, 1);
        BezierPatch::Values at;
        const bool along_s = side == kSideT0 || side == kSideT1;
        const double other = side == kSideS1 || side == kSideT1 ? 1 : 0;
        patch.evaluate<1>(along_s ? x : other, along_s ? other : x, at);
        const Vector3 along = (along_s ? at.ds : at.dt).head<3>();
        const bool backwards = side == kSideS0 || side == kSideT1;
        EXPECT_FALSE(cone.isBeyond(along.normalized() * (backwards ? -1 : 1), 0));
      }
    }
  }
}

/// A leaf of a tree and the way to it: from the root, nodes and the number of the child.
struct LeafWay {
  SurfacePiece piece;
  std::vector<std::pair<NearestFirst::Entry, int>> way;
};
void addWays(const SearchTree& tree, NearestFirst::Entry at, LeafWay way,
             std::vector<LeafWay>& ways) {
  const TreePart& part = tree.part(at);
  if (WideTree::isLeaf(at.place)) {
    way.piece = part.leaves[static_cast<std::size_t>(WideTree::leaf(at.place))].piece;
    ways.push_back(way);
    return;
  }
  const WideTree::Node& node = part.nodes[static_cast<std::size_t>(at.place)];
  for (int i = 0; i < node.count; ++i) {
    way.way.emplace_back(at, i);
    addWays(tree, {node.children[i], 0, at.part}, way, ways);
    way.way.pop_back();
  }
}

/// A patch of a leaf: the leaf itself, or one some steps closer to the vertex of a core.
BezierPatch somePatch(const SearchTree& tree, const SurfacePiece& leaf, Random& random) {
  if (!leaf.isCore()) {
    return tree.patches.patch(leaf);
  }
  SurfacePatches::SplitCore split;
  SurfacePiece core = leaf;
  for (int steps = random.below(12); steps >= 0; --steps) {
    tree.patches.splitPatches(core, split);
    core = split.core;
  }
  return split.patches[random.below(3)];
}

/// Points whose way to a place of the surface is along its normal there, or leads from outside
/// perpendicularly to the border.
TEST(NormalCones, NoLocalMinimumIsLeftOut) {
  Random random(4);
  int inside = 0, on_border = 0, left_out = 0;
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SearchTree tree(surface, 1);
    if (tree.empty()) {
      continue;
    }
    const NormalCones cones(tree, 1);
    std::vector<LeafWay> ways;
    addWays(tree, SearchTree::kRoot, {}, ways);
    for (int round = 0; round < 400; ++round) {
      const auto leaf = static_cast<std::size_t>(random.below(static_cast<int>(ways.size())));
      const BezierPatch patch = somePatch(tree, ways[leaf].piece, random);
      double s = random.uniform(), t = random.uniform();
      const unsigned sides[] = {kSideS0, kSideS1, kSideT0, kSideT1};
      const unsigned side = sides[random.below(4)];
      const bool ends = (patch.borders & side) != 0;
      if (ends) {
        (side == kSideS0 || side == kSideS1 ? s : t) = side == kSideS1 || side == kSideT1;
      }
      BezierPatch::Values at;
      patch.evaluate<1>(s, t, at);
      const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
      if (!(normal.norm() > 1e-3 * ds.norm() * dt.norm())) {
        continue;
      }
      const Vector3 facing = normal.normalized();
      const Vector3 place = tree.inBoxes((patch.anchor + at.value).head<3>());
      Vector3 way = random.uniform(-0.3, 0.3) * facing;
      if (ends) {
        const Vector3 out = side == kSideS0 || side == kSideS1
                                ? Vector3((side == kSideS0 ? -1 : 1) * dt.cross(facing))
                                : Vector3((side == kSideT0 ? 1 : -1) * ds.cross(facing));
        way += random.uniform(0, 0.3) * out.normalized();
      }
      ++(ends ? on_border : inside);
      bool is_left_out = false;
      for (const auto& [node, child] : ways[leaf].way) {
        EXPECT_FALSE(cones.cannotFace(node, child, place + way, facing, 1e-3))
            << name << ", leaf " << leaf;
        // The wrong side, for comparison: a search that leaves out nothing would pass.
        is_left_out = is_left_out || cones.cannotFace(node, child, place + way, -facing, 1e-3);
      }
      left_out += is_left_out;
    }
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(on_border, 1000);
  EXPECT_GT(left_out, 5000);
}

}  // namespace
}  // namespace limitsurf::test
