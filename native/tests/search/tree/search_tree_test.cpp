// SPDX-License-Identifier: Apache-2.0
//
// The parts of a search tree: together they hold the whole surface, in boxes that contain it, and
// those below faces with extraordinary vertices are only made when a search comes near.
#include "limitsurf/search/tree/search_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "support/cages/cage_builder.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Half a thousandth of a percent of the diagonal: more than single precision rounds.
constexpr double kRounding = 5e-6;

double area(const FaceRectangle& on) { return std::abs((on.us + on.ut) * (on.vs + on.vt)); }

/// Walks through a tree and checks the boxes against points of the surface.
class Walk {
 public:
  Walk(const SearchTree& tree, Random& random)
      : covered(static_cast<std::size_t>(tree.surface.faceCount()), 0),
        tree_(tree),
        random_(random) {}

  /// What is at `at` lies in the boxes.
  void visit(NearestFirst::Entry at, std::vector<Box> boxes, std::vector<LeafBox> closer_boxes) {
    const TreePart& part = tree_.part(at);
    if (WideTree::isLeaf(at.place)) {
      const SearchLeaf& leaf = part.leaves[static_cast<std::size_t>(WideTree::leaf(at.place))];
      visitLeaf(leaf, boxes, closer_boxes);
      if (at.part == SearchTree::kTop) {
        expectWithin(leaf.box, closer_boxes);
      } else if (!leaf.piece.isCore()) {
        expectWithin(tree_.patches.patch(leaf.piece), closer_boxes);
      }
      return;
    }
    const WideTree::Node& node = part.nodes[static_cast<std::size_t>(at.place)];
    for (int i = 0; i < node.count; ++i) {
      Box box;
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = node.bounds[axis][0][i];
        box.high[axis] = node.bounds[axis][1][i];
      }
      boxes.push_back(box);
      const bool is_close = node.closer >= 0 && (tree_.closerBoxes(node).children >> i & 1) != 0;
      if (is_close) {
        const LeafBox& box_below = tree_.closerBoxes(node).boxes[i];
        expectWithin(box_below, closer_boxes);
        closer_boxes.push_back(box_below);
        ++closer;
      }
      visit({node.children[i], 0, at.part}, boxes, closer_boxes);
      boxes.pop_back();
      if (is_close) closer_boxes.pop_back();
    }
  }

  std::vector<double> covered;  ///< the area of each face's leaves, of their parameters
  int points = 0, closer = 0;

 private:
  void visitLeaf(const SearchLeaf& leaf, const std::vector<Box>& boxes,
                 const std::vector<LeafBox>& closer_boxes) {
    const bool is_ring =
        leaf.piece.isCore() && tree_.rings.isLarge(tree_.patches.ringOf(leaf.piece));
    std::vector<SurfacePiece> pieces{leaf.piece};
    if (is_ring) {
      const int ring = tree_.patches.ringOf(leaf.piece);
      pieces = tree_.rings.cores(ring, tree_.rings.firstLevel(ring));
    }
    for (const SurfacePiece& piece : pieces) {
      const FaceRectangle on = tree_.patches.rectangle(piece);
      covered[static_cast<std::size_t>(on.face)] += area(on);
      for (int i = 0; i < 4; ++i) {
        const Location at = on.at(random_.uniform(), random_.uniform());
        const Vector3 place =
            tree_.scale * tree_.surface.evaluate({&at, 1}, Derivatives::none, false, 1)
                              .position.row(0)
                              .transpose();
        const Vector3 in_boxes = tree_.inBoxes(place);
        for (const Box& box : boxes) {
          EXPECT_LE((box.low - in_boxes).maxCoeff(), kRounding);
          EXPECT_LE((in_boxes - box.high).maxCoeff(), kRounding);
        }
        EXPECT_LE(std::sqrt(leaf.box.squaredDistance(in_boxes)), kRounding);
        for (const LeafBox& box : closer_boxes) {
          EXPECT_EQ(box.squaredDistance(in_boxes), 0);
        }
        ++points;
      }
    }
  }

  /// The boxes around a nest hold its patches, but not what the boxes of its leaves have besides.
  void expectWithin(const BezierPatch& patch, const std::vector<LeafBox>& boxes) const {
    for (const BezierPatch::Point& point : patch.points) {
      const Vector3 place = (patch.anchor + point).head<3>().matrix() - tree_.middle;
      for (const LeafBox& box : boxes) {
        EXPECT_LE(box.squaredDistance(place), 1e-30);
      }
    }
  }
  /// A box is what its rounded axes bound, which is more than what its corners span.
  static void expectWithin(const LeafBox& inner, const std::vector<LeafBox>& boxes) {
    Eigen::Matrix3d axes;
    Vector3 middle = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      axes.row(i) = inner.axis(i);
    }
    for (int i = 0; i < 8; ++i) {
      middle += inner.corner(i).head<3>().matrix() / 8;
    }
    const Eigen::Matrix3d back = axes.inverse();
    for (int i = 0; i < 8; ++i) {
      Vector3 along;
      for (int axis = 0; axis < 3; ++axis) {
        along[axis] = (i >> axis & 1 ? 1 : -1) * double{inner.half(axis)};
      }
      for (const LeafBox& box : boxes) {
        EXPECT_EQ(box.squaredDistance(middle + back * along), 0);
      }
    }
  }

  const SearchTree& tree_;
  Random& random_;
};

TEST(SearchTree, LeavesCoverAllFacesWithinTheirBoxes) {
  Random random(1);
  int nests = 0;
  for (const auto& [name, cage] : queryCages()) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const SearchTree tree(surface, 1);
    if (tree.empty()) {
      continue;
    }
    Walk walk(tree, random);
    walk.visit(SearchTree::kRoot, {}, {});
    EXPECT_EQ(tree.nestsMade(), tree.nestCount());
    nests += tree.nestCount();
    for (int tile = 0; tile < tree.patches.tileCount(); ++tile) {
      const auto face = static_cast<std::size_t>(tree.patches.rectangle({tile, 0, 0}).face);
      EXPECT_NEAR(walk.covered[face], 1, 1e-12) << face;
    }
  }
  EXPECT_GT(nests, 200);
}

/// A sheet of triangles: all faces have extraordinary vertices.
Cage sheetOfTriangles() { return inTriangles(perturbed(fullGrid(30, 30), 0.1, 1)); }

TEST(SearchTree, AFewSearchesMakeFewNests) {
  const LimitSurface surface = limitSurface(sheetOfTriangles());
  const SearchTree tree(surface, 1);
  EXPECT_EQ(tree.nestsMade(), 0);
  NearestFirst::Entry at = SearchTree::kRoot;
  while (at.part == SearchTree::kTop) {  // down to the first nest
    const WideTree::Node& node = tree.part(at).nodes[static_cast<std::size_t>(at.place)];
    at = {node.children[0], 0, at.part};
    if (at.place >= static_cast<std::int32_t>(tree.top().nodes.size())) {
      EXPECT_EQ(tree.nestsMade(), 0);
      tree.part(at);
    }
  }
  EXPECT_EQ(tree.nestsMade(), 1);
  EXPECT_GT(tree.nestCount(), 5000);
}

/// The number of nests of the top whose boxes contain a point.
int nestsAt(const SearchTree& tree, const Vector3& point, bool looks_closer,
            std::int32_t place = SearchTree::kRoot.place) {
  const auto nodes = static_cast<std::int32_t>(tree.top().nodes.size());
  if (WideTree::isLeaf(place) || place >= nodes) {
    return place >= nodes ? 1 : 0;
  }
  const WideTree::Node& node = tree.top().nodes[static_cast<std::size_t>(place)];
  int nests = 0;
  for (int child = 0; child < node.count; ++child) {
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside = is_inside && node.bounds[axis][0][child] <= point[axis] &&
                  point[axis] <= node.bounds[axis][1][child];
    }
    if (looks_closer && node.closer >= 0 && (tree.closerBoxes(node).children >> child & 1) != 0) {
      is_inside = is_inside && tree.closerBoxes(node).boxes[child].squaredDistance(point) == 0;
    }
    nests += is_inside ? nestsAt(tree, point, looks_closer, node.children[child]) : 0;
  }
  return nests;
}

/// The boxes of long and thin faces along the coordinate axes overlap. Without oriented ones, a
/// search near a pole would enter most of the nests.
TEST(SearchTree, FewNestsOfLongThinFacesAreAtAPoint) {
  const LimitSurface surface = limitSurface(pole(500));
  const SearchTree tree(surface, 1);
  EXPECT_EQ(tree.nestCount(), surface.faceCount());
  Random random(8);
  int most = 0, most_along_axes = 0;
  for (int i = 0; i < 200; ++i) {
    const Location at = {random.below(surface.faceCount()), random.uniform(), random.uniform()};
    const Vector3 place =
        tree.scale *
        surface.evaluate({&at, 1}, Derivatives::none, false).position.row(0).transpose();
    most = std::max(most, nestsAt(tree, tree.inBoxes(place), true));
    most_along_axes = std::max(most_along_axes, nestsAt(tree, tree.inBoxes(place), false));
  }
  EXPECT_LE(most, 20);
  EXPECT_GT(most_along_axes, 100);
}

/// A sheet of long and narrow faces that lie aslant.
Cage slenderSheet(double length, std::uint64_t seed) {
  Cage cage = perturbed(grid(20, 20), 0.1, seed);
  cage.positions.col(0) *= length;
  const Vector3 axis = Random(seed).vector(1).normalized();
  const Eigen::AngleAxis<double> turn(0.7, axis);
  cage.positions = (cage.positions * turn.toRotationMatrix().transpose()).eval();
  return cage;
}

/// They have closer boxes, which hold what is below them; meshes of usual faces have hardly any.
TEST(SearchTree, LongThinFacesLieInCloserBoxes) {
  Random random(5);
  const auto closerBoxes = [&](const Cage& cage) {
    const LimitSurface surface = limitSurface(cage);
    const SearchTree tree(surface, 1);
    Walk walk(tree, random);
    walk.visit(SearchTree::kRoot, {}, {});
    return walk.closer;
  };
  EXPECT_GT(closerBoxes(pole(500)), 100);
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const double length : {100., 1e4, 1e8}) {
      EXPECT_GT(closerBoxes(slenderSheet(length, seed)), 5) << length;
    }
    EXPECT_LE(closerBoxes(slenderSheet(1, seed)), 1);
  }
  EXPECT_EQ(closerBoxes(pole(12)), 0);
}

/// Points and rays from near and far, also beside a face that is far away. No sample of the surface
/// is closer than the closest point, and rays that are aimed at samples hit there or before.
TEST(SearchTree, SearchesAmongLongThinFacesMissNothing) {
  constexpr int kSide = 24;
  for (const bool has_outlier : {false, true}) {
    CageBuilder builder;
    builder.append(slenderSheet(300, 4));
    if (has_outlier) {
      builder.append(placed(fullGrid(1, 1), 1, Vector3(3e8, 1e8, -2e8)));
    }
    const LimitSurface surface = limitSurface(builder.build());
    const SearchTree tree(surface, 1);
    ASSERT_EQ(tree.crowd.has_value(), has_outlier);
    const SurfaceSearch search(surface);
    std::vector<Location> at;
    for (int face = 0; face + (has_outlier ? 1 : 0) < surface.faceCount(); ++face) {
      for (int i = 0; i <= kSide; ++i) {
        for (int j = 0; j <= kSide; ++j) {
          at.push_back({face, double(i) / kSide, double(j) / kSide});
        }
      }
    }
    const Points samples = surface.evaluate(at, Derivatives::none, false).position;
    const double size = (samples.colwise().maxCoeff() - samples.colwise().minCoeff()).norm();
    Random random(7);
    constexpr int kPoints = 300;
    Points points(kPoints, 3), directions(kPoints, 3);
    std::vector<double> lengths(kPoints);
    for (int i = 0; i < kPoints; ++i) {
      const double away[] = {1e-6, 1e-3, 0.05, 1, 100};
      const Vector3 direction = random.vector(1).normalized();
      const int sample = random.below(static_cast<int>(samples.rows()));
      lengths[i] = size * away[i % 5];
      points.row(i) = samples.row(sample) - lengths[i] * direction.transpose();
      directions.row(i) = direction.transpose();
    }
    const double error = 2e-12 * size + (has_outlier ? 2e-12 * 4e8 : 0);
    const Hits closest = search.closest(points), hits = search.rayCast(points, directions);
    for (int i = 0; i < kPoints; ++i) {
      const double nearest = (samples.rowwise() - points.row(i)).rowwise().norm().minCoeff();
      EXPECT_LE(closest.distance[i], nearest + error) << i;
      EXPECT_NEAR((closest.position.row(i) - points.row(i)).norm(), closest.distance[i], error);
      ASSERT_GE(hits.at[i].face, 0) << i;
      EXPECT_LE(hits.distance[i], lengths[i] + 1e3 * error) << i;
      const Points met = surface.evaluate({&hits.at[i], 1}, Derivatives::none, false).position;
      EXPECT_LE((points.row(i) + hits.distance[i] * directions.row(i) - met).norm(), error);
    }
  }
}

/// After as many searches as there are nests, no search has to make one.
TEST(SearchTree, ManySearchesMakeAllNests) {
  const LimitSurface surface = limitSurface(sheetOfTriangles());
  const SearchTree tree(surface, 1);
  const auto half = static_cast<std::size_t>(tree.nestCount() / 2);
  tree.prepare(half, 1);
  EXPECT_EQ(tree.nestsMade(), 0);
  tree.prepare(half + 1, 1);
  EXPECT_EQ(tree.nestsMade(), tree.nestCount());
}

/// Results depend neither on which searches came before nor on the number of threads, which race to
/// make the same nests.
TEST(SearchTree, ResultsDoNotDependOnTheNestsThatAreMade) {
  const LimitSurface surface = limitSurface(sheetOfTriangles());
  Random random(3);
  Points points(3000, 3);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points.row(row) << random.uniform(0, 30), random.uniform(0, 30), random.uniform(-3, 3);
  }
  const SurfaceSearch search(surface, 1);
  const Hits first = search.closest(points, {}, 1), again = search.closest(points, {}, 1);
  for (int round = 0; round < 4; ++round) {
    const SurfaceSearch fresh(surface);
    std::vector<Hits> found(4);
    std::vector<std::thread> threads;
    for (Hits& hits : found) {
      threads.emplace_back([&] { hits = fresh.closest(points, {}, 1); });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    found.push_back(again);
    for (const Hits& hits : found) {
      EXPECT_TRUE(hits.position == first.position && hits.distance == first.distance);
      for (std::size_t row = 0; row < first.at.size(); ++row) {
        ASSERT_EQ(hits.at[row].face, first.at[row].face);
        ASSERT_EQ(hits.at[row].u, first.at[row].u);
        ASSERT_EQ(hits.at[row].v, first.at[row].v);
      }
    }
  }
}

/// Hits in the memory of earlier ones, more and fewer, are the same as new ones.
TEST(SearchTree, HitsInTheMemoryOfEarlierOnesAreTheSame) {
  const LimitSurface surface = limitSurface(sheetOfTriangles());
  const SurfaceSearch search(surface, 1);
  Random random(4);
  Points points(300, 3), directions(300, 3);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points.row(row) << random.uniform(-5, 35), random.uniform(-5, 35), random.uniform(-3, 3);
    directions.row(row) = random.vector(1).transpose();
  }
  const auto expectSame = [](const Hits& hits, const Hits& fresh) {
    ASSERT_EQ(hits.at.size(), fresh.at.size());
    ASSERT_EQ(hits.position.rows(), fresh.position.rows());
    ASSERT_EQ(hits.normal.rows(), fresh.normal.rows());
    ASSERT_EQ(hits.distance.size(), fresh.distance.size());
    for (std::size_t i = 0; i < fresh.at.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      ASSERT_EQ(hits.at[i].face, fresh.at[i].face);
      if (fresh.at[i].face < 0) {
        EXPECT_TRUE(std::isnan(hits.at[i].u) && std::isnan(hits.distance[row]));
        EXPECT_TRUE(hits.position.row(row).array().isNaN().all());
        continue;
      }
      EXPECT_EQ(hits.at[i].u, fresh.at[i].u);
      EXPECT_EQ(hits.distance[row], fresh.distance[row]);
      EXPECT_EQ(hits.position.row(row), fresh.position.row(row));
      EXPECT_EQ(hits.normal.row(row), fresh.normal.row(row));
    }
  };
  ClosestOptions options;
  options.max_distance = 2;
  Hits hits;
  int missed = 0;
  for (const Eigen::Index count : {200, 300, 100, 0, 150}) {
    const auto from = points.topRows(count), along = directions.topRows(count);
    search.closest(from, options, hits);
    expectSame(hits, search.closest(from, options));
    search.rayCast(from, along, 10, hits);
    expectSame(hits, search.rayCast(from, along, 10));
    for (const Location& at : hits.at) {
      missed += at.face < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(missed, 50);
}

/// What there is no room for is kept elsewhere.
TEST(SearchTree, TheStoreKeepsTheFirstOfTwoNests) {
  BuiltPart built;
  built.nodes.resize(2);
  built.leaves.resize(5);
  built.patches.resize(5);
  for (std::size_t leaf = 0; leaf < 5; ++leaf) {
    built.leaves[leaf].piece.tile = static_cast<int>(leaf);
  }
  for (const std::size_t room : {0, 5, 12, 100}) {
    NestStore store({3, room, room, room});
    for (const std::size_t nest : {0, 1, 2}) {
      EXPECT_EQ(store.made(nest), nullptr);
      const TreePart& kept = store.keep(nest, built);
      EXPECT_EQ(store.made(nest), &kept);
      EXPECT_EQ(&store.keep(nest, built), &kept);
      EXPECT_EQ(kept.nodes.size(), 2u);
      ASSERT_EQ(kept.leaves.size(), 5u);
      EXPECT_EQ(kept.leaves[4].piece.tile, 4);
      EXPECT_TRUE(kept.kept.empty() || kept.kept.size() == 5);
      EXPECT_TRUE(room > 0 || kept.kept.empty());
    }
    EXPECT_EQ(store.made(0)->kept.size(), room >= 5 ? 5u : 0u);
  }
}

}  // namespace
}  // namespace limitsurf::test
