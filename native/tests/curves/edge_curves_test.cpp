// SPDX-License-Identifier: Apache-2.0
//
// Chains of edges and their arc lengths. Boundaries and infinitely sharp creases are uniform cubic
// B-splines of their vertices: their lengths are found without the surface, in high precision.
#include "limitsurf/curves/edge_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "limitsurf/error.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/local_mesh.h"

namespace limitsurf::test {
namespace {

using std::abs;
using std::sqrt;

/// Composite Gauss-Legendre quadrature of a function on [0, 1], of 5 points on each of many parts.
template <typename Number, typename Function>
Number integral(const Function& function, int parts) {
  static const double kAt[3] = {0, 0.53846931010568309104, 0.90617984593866399280};
  static const double kWeight[3] = {0.56888888888888888889, 0.47862867049936646804,
                                    0.23692688505618908751};
  Number sum = 0;
  for (int part = 0; part < parts; ++part) {
    for (int i = -2; i <= 2; ++i) {
      const Number x = (i < 0 ? -1 : 1) * Number(kAt[std::abs(i)]);
      sum += Number(kWeight[std::abs(i)]) * function((part + (1 + x) / 2) / parts);
    }
  }
  return sum / (2 * parts);
}

/// The speed of a uniform cubic B-spline.
Real splineSpeed(const Points& p, const std::array<int, 4>& at, const Real& t) {
  const Real weights[4] = {-(1 - t) * (1 - t) / 2, (3 * t * t - 4 * t) / 2,
                           (-3 * t * t + 2 * t + 1) / 2, t * t / 2};
  Real squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Real sum = 0;
    for (int i = 0; i < 4; ++i) {
      sum += weights[i] * Real(p(at[static_cast<std::size_t>(i)], axis));
    }
    squared += sum * sum;
  }
  return boost::multiprecision::sqrt(squared);
}

/// The length of part [0, to] of an edge of a closed curve.
double splineLength(const EdgeCurves& curves, const Points& p, int curve, std::int64_t edge,
                    double to = 1, int parts = 24) {
  const std::int64_t first = curves.offsets()[static_cast<std::size_t>(curve)];
  const std::int64_t count = curves.offsets()[static_cast<std::size_t>(curve) + 1] - first;
  std::array<int, 4> at;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t of = first + (edge - first + i - 1 + count) % count;
    at[static_cast<std::size_t>(i)] = curves.edgeVertices(of).first;
  }
  const Real end = to;
  return static_cast<double>(
      end * integral<Real>([&](const Real& t) { return splineSpeed(p, at, end * t); }, parts));
}

std::vector<std::pair<std::string, Cage>> openCages() {
  std::vector<std::pair<std::string, Cage>> cages = {
      {"cross", perturbed(cross(), 0.1, 1)},
      {"holes", perturbed(gridWithHoles(6, 5, {8, 21}), 0.2, 2)},
      {"mixture", mixture(3)},
      {"prism", prism(7, false)}};
  for (const int faces : {1, 2, 3, 4, 8, 20}) {
    cages.emplace_back("fan of " + std::to_string(faces), fan(faces, false, 5));
  }
  return cages;
}

TEST(EdgeCurves, BoundariesAreAsLongAsTheirSplines) {
  for (const auto& [name, cage] : openCages()) {
    SCOPED_TRACE(name);
    const EdgeCurves curves(limitSurface(cage), EdgeChoice::boundary);
    ASSERT_GT(curves.count(), 0);
    for (int curve = 0; curve < curves.count(); ++curve) {
      ASSERT_TRUE(curves.closed(curve));
      double sum = 0;
      for (auto edge = curves.offsets()[static_cast<std::size_t>(curve)];
           edge < curves.offsets()[static_cast<std::size_t>(curve) + 1]; ++edge) {
        const double truth = splineLength(curves, cage.positions, curve, edge);
        EXPECT_NEAR(curves.edgeLength(edge), truth, kCurveLengthError * truth);
        sum += truth;
      }
      EXPECT_NEAR(curves.length(curve), sum, kCurveLengthError * sum);
    }
  }
}

TEST(EdgeCurves, CuspsAndNarrowTurnsKeepTheBound) {
  Cage cage = grid(3, 3);
  // The curve turns back at a double vertex, and almost so at another place.
  cage.positions.row(1) = cage.positions.row(0);
  for (const double beside : {0., 1e-3, 1e-6}) {
    cage.positions.row(2) << 0.3, beside, 0.1;
    const EdgeCurves curves(limitSurface(cage), EdgeChoice::boundary);
    for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
      const double truth = splineLength(curves, cage.positions, 0, edge, 1, 400);
      EXPECT_NEAR(curves.edgeLength(edge), truth, kCurveLengthError * curves.length(0));
    }
  }
}

/// A strip whose boundary runs back and forth along a line: each cusp of the spline divides an edge
/// in two, anywhere, also closer to its end than all points of a quadrature.
TEST(EdgeCurves, CuspsAnywhereKeepTheBound) {
  Random random(5);
  int close_to_an_end = 0;
  for (int round = 0; round < 200; ++round) {
    const int length = 6;
    Cage cage = fullGrid(length, 1);
    std::array<double, length + 1> x;
    for (int i = 0; i <= length; ++i) {
      x[static_cast<std::size_t>(i)] = (i & 1) + 0.05 * random.uniform(-1, 1);
      cage.positions.row(i) << x[static_cast<std::size_t>(i)], 0, 0;
      cage.positions.row(length + 1 + i) << x[static_cast<std::size_t>(i)], 0, 1;
    }
    for (int i = 1; i + 2 <= length; ++i) {
      const EdgeCurves curves(limitSurface(cage), {{i, i + 1}});
      // The total variation of the spline, which is a cubic polynomial of one coordinate
      const double* p = &x[static_cast<std::size_t>(i - 1)];
      const auto value = [&](double t) {
        const double s = 1 - t;
        return (s * s * s * p[0] + (3 * t * t * t - 6 * t * t + 4) * p[1] +
                (-3 * t * t * t + 3 * t * t + 3 * t + 1) * p[2] + t * t * t * p[3]) /
               6;
      };
      const double a = (p[3] - 3 * p[2] + 3 * p[1] - p[0]) / 2, b = p[0] - 2 * p[1] + p[2],
                   c = (p[2] - p[0]) / 2, root = std::sqrt(std::max(0., b * b - 4 * a * c));
      std::vector<double> ends = {0, 1};
      for (const double t : {2 * c / (-b + root), 2 * c / (-b - root)}) {
        if (t > 0 && t < 1) {
          ends.push_back(t);
          close_to_an_end += std::min(t, 1 - t) < 0.0065;
        }
      }
      std::sort(ends.begin(), ends.end());
      double truth = 0;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        truth += std::abs(value(ends[k + 1]) - value(ends[k]));
      }
      EXPECT_NEAR(curves.length(0), truth, kCurveLengthError * truth) << round << ", edge " << i;
      // Half of it is where half of the variation is.
      const EdgeCurves::Point half = curves.at(0, truth / 2, CurveSide::left);
      double before = 0;
      for (std::size_t k = 0; k + 1 < ends.size() && ends[k] < half.fraction; ++k) {
        before += std::abs(value(std::min(ends[k + 1], half.fraction)) - value(ends[k]));
      }
      EXPECT_NEAR(before, truth / 2, 2 * kCurveLengthError * truth) << round << ", edge " << i;
    }
  }
  EXPECT_GT(close_to_an_end, 5);
}

TEST(EdgeCurves, InfinitelySharpCreasesAreSplines) {
  Cage cage = perturbed(torus(8, 6), 0.1, 4);
  // The edges of one ring, through which only the crease runs.
  const std::vector<std::pair<int, int>> edges = edgesOf(cage);
  std::vector<std::pair<std::int64_t, std::int64_t>> ring;
  const LimitSurface smooth = limitSurface(cage);
  const EdgeCurves all(smooth, {{edges[0].first, edges[0].second}});
  ASSERT_EQ(all.count(), 1);
  for (int start = edges[0].first, previous = -1, vertex = edges[0].second; vertex != start;) {
    if (previous < 0) {
      sharpenEdge(cage, start, vertex, 10);
      previous = start;
    }
    // In a torus the next edge of a ring is the one that shares no face with the last.
    for (const auto& [a, b] : edges) {
      const int other = a == vertex ? b : b == vertex ? a : -1;
      if (other < 0 || other == previous) {
        continue;
      }
      bool shares = false;
      for (const std::vector<int>& face : cage.faces) {
        const auto has = [&](int v) { return std::count(face.begin(), face.end(), v) > 0; };
        shares |= has(previous) && has(vertex) && has(other);
      }
      if (!shares) {
        sharpenEdge(cage, vertex, other, 10);
        previous = vertex;
        vertex = other;
        break;
      }
    }
  }
  const EdgeCurves curves(limitSurface(cage), EdgeChoice::creases);
  ASSERT_EQ(curves.count(), 1);
  ASSERT_TRUE(curves.closed(0));
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    EXPECT_GE(curves.edgeFace(edge, CurveSide::left), 0);
    EXPECT_GE(curves.edgeFace(edge, CurveSide::right), 0);
    const double truth = splineLength(curves, cage.positions, 0, edge);
    EXPECT_NEAR(curves.edgeLength(edge), truth, kCurveLengthError * truth);
  }
}

/// The length of a smooth edge from derivatives along it, on parts that shrink towards both ends.
double evaluatedLength(const LimitSurface& surface, const EdgeCurves& curves, std::int64_t edge) {
  // Locations along the edge, of both halves of an n-gon's edge, by fraction.
  const int face = curves.edgeFace(edge, CurveSide::left);
  const auto [from, to] = curves.edgeVertices(edge);
  const Span<int> vertices = surface.mesh().faceVertices(face);
  int first = 0, corner = 0;
  while (surface.baseFace()[static_cast<std::size_t>(first)] != face) {
    ++first;
  }
  const int size = surface.mesh().faceSize(face);
  while (vertices[static_cast<std::size_t>(corner)] != from ||
         vertices[static_cast<std::size_t>((corner + 1) % size)] != to) {
    ++corner;
  }
  const auto half = [&](const Location& start, double du, double dv) {
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
      double high = 0.5;
      for (int depth = 0; depth < 47; ++depth, high /= 2) {
        const double low = depth == 46 ? 0 : high / 2;
        sum += (high - low) *
               integral<double>(
                   [&](double t) {
                     double x = low + (high - low) * t;
                     x = end == 0 ? x : 1 - x;
                     const Evaluation here = surface.evaluate(
                         std::vector<Location>{{start.face, start.u + du * x, start.v + dv * x}},
                         Derivatives::first);
                     return (du * here.du + dv * here.dv).norm();
                   },
                   depth < 12 ? 8 : 1);
      }
    }
    return sum;
  };
  if (size == 4) {
    const Location start = cornerLocation(first, corner),
                   end = cornerLocation(first, (corner + 1) % 4);
    return half(start, end.u - start.u, end.v - start.v);
  }
  return half({first + corner, 0, 0}, 1, 0) + half({first + (corner + 1) % size, 0, 1}, 0, -1);
}

TEST(EdgeCurves, EdgesBetweenFacesAtExtraordinaryVertices) {
  Cage semi_sharp = perturbed(cube(), 0.1, 8);
  sharpenEdge(semi_sharp, semi_sharp.faces[0][0], semi_sharp.faces[0][1], 1.7);
  sharpenEdge(semi_sharp, semi_sharp.faces[0][1], semi_sharp.faces[0][2], 10);
  for (const Cage& cage : {perturbed(cube(), 0.1, 3), fan(7, true, 2), fan(40, true, 3), ngon(5, 4),
                           mixture(5), semi_sharp}) {
    const LimitSurface surface = limitSurface(cage);
    std::vector<std::pair<std::int64_t, std::int64_t>> some;
    for (const auto& edge : edgesOf(cage)) {
      if (some.size() < 6) {
        some.emplace_back(edge);
      }
    }
    const EdgeCurves curves(surface, some);
    ASSERT_EQ(curves.edgeCount(), static_cast<std::int64_t>(some.size()));
    for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
      const double truth = evaluatedLength(surface, curves, edge);
      EXPECT_NEAR(curves.edgeLength(edge), truth, kCurveLengthError * truth) << edge;
    }
  }
}

TEST(EdgeCurves, PlacesAreWhereTheArcLengthSays) {
  for (const auto& [name, cage] : openCages()) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const EdgeCurves curves(surface, EdgeChoice::boundary);
    for (int curve = 0; curve < curves.count(); ++curve) {
      const double length = curves.length(curve);
      double before = 0;
      std::int64_t edge = curves.offsets()[static_cast<std::size_t>(curve)];
      for (int i = 0; i <= 23; ++i) {
        const double arc = length * i / 23;
        const EdgeCurves::Point point = curves.at(curve, arc);
        for (; edge < point.edge; ++edge) {
          before += curves.edgeLength(edge);
        }
        const double truth =
            before + splineLength(curves, cage.positions, curve, edge, point.fraction);
        EXPECT_NEAR(truth, arc, (kCurveLengthError + kArcInverseError) * length);
        const Evaluation here = surface.evaluate(std::vector<Location>{point.at});
        EXPECT_LT((here.position.row(0).transpose() - point.position).norm(),
                  2 * kPositionError * diagonal(cage.positions));
        EXPECT_NEAR(point.tangent.norm(), 1, 1e-12);
      }
    }
  }
}

TEST(EdgeCurves, BothSidesNameTheSamePlaces) {
  const Cage cage = mixture(4);
  const LimitSurface surface = limitSurface(cage);
  std::vector<std::pair<std::int64_t, std::int64_t>> all;
  for (const auto& edge : edgesOf(cage)) {
    all.emplace_back(edge);
  }
  const EdgeCurves curves(surface, all);
  int both = 0;
  for (int curve = 0; curve < curves.count(); ++curve) {
    for (const double share : {0.1, 0.45, 0.8}) {
      const double arc = share * curves.length(curve);
      const EdgeCurves::Point left = curves.at(curve, arc, CurveSide::left);
      const EdgeCurves::Point right = curves.at(curve, arc, CurveSide::right);
      const Points at = surface.evaluate(std::vector<Location>{left.at, right.at}).position;
      EXPECT_LT((at.row(0) - at.row(1)).norm(), 1e-12);
      both += left.side != right.side;
      const auto base = [&](const EdgeCurves::Point& p) {
        return surface.baseFace()[static_cast<std::size_t>(p.at.face)];
      };
      EXPECT_EQ(base(left), curves.edgeFace(left.edge, left.side));
      EXPECT_EQ(base(right), curves.edgeFace(right.edge, right.side));
    }
  }
  EXPECT_GT(both, 0);
}

TEST(EdgeCurves, ChainsEndWhereMoreOrFewerThanTwoEdgesMeet) {
  const LimitSurface surface = limitSurface(fullGrid(4, 4));
  // A cross through the middle vertex 12, with one arm that bends.
  const EdgeCurves curves(surface, {{12, 13}, {7, 12}, {11, 12}, {17, 12}, {10, 11}, {17, 18}});
  ASSERT_EQ(curves.count(), 4);
  std::set<std::int64_t> sizes;
  for (int curve = 0; curve < 4; ++curve) {
    EXPECT_FALSE(curves.closed(curve));
    const auto i = static_cast<std::size_t>(curve);
    sizes.insert(curves.offsets()[i + 1] - curves.offsets()[i]);
    for (auto edge = curves.offsets()[i]; edge + 1 < curves.offsets()[i + 1]; ++edge) {
      EXPECT_EQ(curves.edgeVertices(edge).second, curves.edgeVertices(edge + 1).first);
    }
  }
  EXPECT_EQ(sizes, (std::set<std::int64_t>{1, 2}));
}

TEST(EdgeCurves, BoundariesHaveTheSurfaceOnTheirLeft) {
  const Cage cage = gridWithHoles(6, 5, {8, 21});
  const EdgeCurves curves(limitSurface(cage), EdgeChoice::boundary);
  ASSERT_EQ(curves.count(), 3);
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    const std::vector<int>& face =
        cage.faces[static_cast<std::size_t>(curves.edgeFace(edge, CurveSide::left))];
    const auto [from, to] = curves.edgeVertices(edge);
    const auto at = std::find(face.begin(), face.end(), from);
    ASSERT_NE(at, face.end());
    EXPECT_EQ(to, at + 1 == face.end() ? face.front() : at[1]);
    EXPECT_EQ(curves.edgeFace(edge, CurveSide::right), -1);
  }
}

TEST(EdgeCurves, EdgesWithoutASurfaceAreLeftOut) {
  Cage cage = grid(3, 3);
  cage.options.holes = {0};
  const EdgeCurves boundary(limitSurface(cage), EdgeChoice::boundary);
  EXPECT_EQ(boundary.leftOut(), 2);
  EXPECT_EQ(boundary.edgeCount(), 10);
  ASSERT_EQ(boundary.count(), 1);
  EXPECT_FALSE(boundary.closed(0));
}

TEST(EdgeCurves, NonManifoldEdgesAreCreases) {
  for (const auto& [name, cage] : nonManifoldCages()) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const EdgeCurves curves(surface, EdgeChoice::creases);
    for (int curve = 0; curve < curves.count(); ++curve) {
      const EdgeCurves::Point point = curves.at(curve, 0.5 * curves.length(curve));
      const Evaluation here = surface.evaluate(std::vector<Location>{point.at});
      EXPECT_LT((here.position.row(0).transpose() - point.position).norm(), 1e-12);
    }
  }
}

TEST(EdgeCurves, AnEdgeThatTheMeshHasNotIsNamed) {
  const LimitSurface surface = limitSurface(fullGrid(2, 2));
  try {
    EdgeCurves(surface, {{0, 1}, {0, 8}});
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find("row 1"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("0 and 8"), std::string::npos);
  }
}

TEST(EdgeCurves, ThreadsGiveTheSameBits) {
  const LimitSurface surface = limitSurface(mixture(6));
  const EdgeCurves one(surface, EdgeChoice::boundary, 1), many(surface, EdgeChoice::boundary, 3);
  ASSERT_EQ(one.edgeCount(), many.edgeCount());
  for (std::int64_t edge = 0; edge < one.edgeCount(); ++edge) {
    EXPECT_EQ(one.edgeLength(edge), many.edgeLength(edge));
  }
}

}  // namespace
}  // namespace limitsurf::test
