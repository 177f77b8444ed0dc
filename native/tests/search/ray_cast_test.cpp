// SPDX-License-Identifier: Apache-2.0
//
// Rays, compared with known points of the surface, with all roots that dense samples and Newton's
// iteration find, and with what must hold for a closed surface.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/throws.h"
#include "support/truth/brute_force.h"
#include "support/truth/corner_points.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Rays {
  std::vector<Vector3> origins, directions;

  void add(const Vector3& origin, const Vector3& direction) {
    origins.push_back(origin);
    directions.push_back(direction);
  }
  static Points rows(const std::vector<Vector3>& from) {
    Points points(static_cast<Eigen::Index>(from.size()), 3);
    for (std::size_t i = 0; i < from.size(); ++i) {
      points.row(static_cast<Eigen::Index>(i)) = from[i];
    }
    return points;
  }
  Points originRows() const { return rows(origins); }
  Points directionRows() const { return rows(directions); }
  std::size_t size() const { return origins.size(); }
};

std::string textOf(const Vector3& origin, const Vector3& direction) {
  char text[200];
  std::snprintf(text, sizeof text, "origin (%.17g, %.17g, %.17g), direction (%.17g, %.17g, %.17g)",
                origin[0], origin[1], origin[2], direction[0], direction[1], direction[2]);
  return text;
}

Vector3 direction(Random& random) {
  for (;;) {
    const Vector3 v = random.vector(1);
    if (v.norm() < 1 && v.norm() > 0.01) return v.normalized();
  }
}

Vector3 middleOf(const LimitSurface& surface) {
  return ((surface.positions().colwise().minCoeff() + surface.positions().colwise().maxCoeff()) / 2)
      .transpose();
}

double diagonalOf(const LimitSurface& surface) { return diagonal(surface.positions()); }

/// Expects that a hit is a point of the surface and of the ray, at the distance that it states.
void expectOnTheRay(const std::string& where, const LimitSurface& surface, const WideRay& ray,
                    const Hits& hits, Eigen::Index row) {
  const Location& at = hits.at[static_cast<std::size_t>(row)];
  const Evaluation e = surface.evaluate({&at, 1}, Derivatives::first, true, 1);
  EXPECT_TRUE(hits.position.row(row) == e.position.row(0)) << where;
  EXPECT_TRUE(hits.normal.row(row) == e.normal.row(0) || e.normal.row(0).hasNaN()) << where;
  const auto [along, aside] = ray.alongAndAside(hits.position.row(row));
  const double allowed =
      kSearchError * diagonalOf(surface) + 0x1p-52 * static_cast<double>(ray.origin.norm());
  EXPECT_LE(aside, allowed) << where << ": the hit " << describe(at) << " is aside of the ray";
  EXPECT_LE(std::abs(static_cast<double>(along - hits.distance[row])), allowed)
      << where << ": the hit " << describe(at) << " is elsewhere along the ray";
  EXPECT_GE(hits.distance[row], 0) << where;
}

/// Whether ray `ray` has a hit at that distance.
bool anyAt(const RayHits& hits, std::size_t ray, double distance, double slack) {
  for (std::int64_t row = hits.offsets[ray]; row < hits.offsets[ray + 1]; ++row) {
    if (std::abs(hits.distance[row] - distance) <= slack) return true;
  }
  return false;
}

/// Expects that rayCast() and rayCastAll() agree.
void expectFirstOfAll(const std::string& name, const LimitSurface& surface, const Rays& rays,
                      const Hits& first, const RayHits& all) {
  ASSERT_EQ(all.offsets.size(), rays.size() + 1);
  ASSERT_EQ(all.offsets.back(), static_cast<std::int64_t>(all.at.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string where = name + ", " + textOf(rays.origins[i], rays.directions[i]);
    const WideRay ray(rays.origins[i], rays.directions[i]);
    const std::int64_t begin = all.offsets[i], end = all.offsets[i + 1];
    for (std::int64_t row = begin; row < end; ++row) {
      expectOnTheRay(where, surface, ray, all, row);
      if (row > begin) {
        EXPECT_GE(all.distance[row], all.distance[row - 1]) << where;
      }
    }
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_EQ(first.at[i].face >= 0, begin < end) << where;
    if (first.at[i].face < 0) {
      EXPECT_TRUE(std::isnan(first.distance[row]) && first.position.row(row).hasNaN()) << where;
    } else if (begin < end) {
      expectOnTheRay(where, surface, ray, first, row);
      EXPECT_LE(std::abs(first.distance[row] - all.distance[begin]), 1e-6 * diagonalOf(surface))
          << where;
    }
  }
}

/// Random rays, half of them from far away.
Rays raysAround(const LimitSurface& surface, int count, Random& random) {
  const double diagonal = diagonalOf(surface);
  const Vector3 middle = middleOf(surface);
  const Points targets = surface.evaluate(searchedLocations(surface, count, random)).position;
  Rays rays;
  for (int i = 0; i < count; ++i) {
    const double far = diagonal * (i % 2 == 0 ? 0.5 : 20);
    const Vector3 origin = middle + far * direction(random);
    const Vector3 target = Vector3(targets.row(i)) + 0.2 * diagonal * random.vector(1);
    rays.add(origin, random.uniform(0.1, 9) * (target - origin));
  }
  return rays;
}

/// Whether the ray, before that distance, enters a stretch on which it runs within the surface.
bool runsWithin(const RayHits& hits, std::size_t ray, const Vector3& along, double distance) {
  for (std::int64_t row = hits.offsets[ray]; row < hits.offsets[ray + 1]; ++row) {
    if (hits.distance[row] <= distance && std::abs(along.dot(hits.normal.row(row))) < 1e-8) {
      return true;
    }
  }
  return false;
}

bool isFlat(const LimitSurface& surface, const Location& at, double unit) {
  const Curvature k = surface.curvature({&at, 1});
  return std::max(std::abs(k.k1[0]), std::abs(k.k2[0])) * unit < 1e-9;
}

void expectNoneTwice(const std::string& where, const RayHits& hits, std::size_t ray) {
  for (std::int64_t a = hits.offsets[ray]; a < hits.offsets[ray + 1]; ++a) {
    for (std::int64_t b = hits.offsets[ray]; b < a; ++b) {
      const Location &one = hits.at[static_cast<std::size_t>(a)],
                     &other = hits.at[static_cast<std::size_t>(b)];
      EXPECT_FALSE(one.face == other.face &&
                   std::abs(one.u - other.u) + std::abs(one.v - other.v) < 1e-10)
          << where << " has " << describe(one) << " twice";
    }
  }
}

/// Every root that brute force finds is found, and no root twice.
void compareWithBruteForce(const NamedCages& cages, int count, int per_side) {
  Random random(1);
  long found = 0;
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const BruteForce truth(surface, per_side);
    const Rays rays = raysAround(surface, count, random);
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    const Hits first = search.rayCast(rays.originRows(), rays.directionRows());
    expectFirstOfAll(name, surface, rays, first, all);
    const double unit = truth.diagonal();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::string where = name + ", " + textOf(rays.origins[i], rays.directions[i]);
      for (const BruteForce::Root& root :
           truth.roots(WideRay(rays.origins[i], rays.directions[i]))) {
        const double distance = static_cast<double>(root.distance);
        if (distance < 1e-9 * unit) continue;
        EXPECT_TRUE(anyAt(all, i, distance, 2 * kSearchError * unit / std::max(root.sine, 1e-5)))
            << where << ": " << describe(root.at) << " at " << distance << " (sine " << root.sine
            << ") was not found";
        ++found;
      }
      expectNoneTwice(where, all, i);
    }
  }
  std::printf("%ld roots found\n", found);
}

TEST(RayCast, FindsWhatBruteForceFinds) { compareWithBruteForce(queryCages(), 12, 16); }

TEST(SlowRayCast, FindsWhatBruteForceFinds) { compareWithBruteForce(queryCages(), 1500, 32); }

TEST(RayCast, FindsThePointsItIsSentThrough) {
  // Targets anywhere, on edges, at vertices and on boundaries; origins on all sides, at distances
  // up to 1000.
  Random random(2);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double unit = diagonalOf(surface);
    std::vector<Location> at = searchedLocations(surface, 150, random);
    for (const Location& vertex : surface.vertexLocations()) {
      if (vertex.face >= 0) at.push_back(vertex);
    }
    const Evaluation e = surface.evaluate(at, Derivatives::first, true);
    Rays rays;
    std::vector<double> distances;
    for (Eigen::Index i = 0; i < e.position.rows(); ++i) {
      const double distance = unit * std::pow(10., random.uniform(-3, 3));
      const Vector3 to = direction(random);
      rays.add(Vector3(e.position.row(i)) - distance * to, to);
      distances.push_back(distance);
    }
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    const Hits first = search.rayCast(rays.originRows(), rays.directionRows());
    expectFirstOfAll(name, surface, rays, first, all);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      // The ray itself is rounded: this is how far it may pass from the point. It counts as a hit
      // also where the point is on a boundary, beyond which the ray then passes.
      const double rounding = 4 * 0x1p-53 * (distances[i] + rays.origins[i].norm());
      const Vector3 normal = e.normal.row(row);
      const double sine = normal.allFinite() ? std::abs(normal.dot(rays.directions[i])) : 1e-3;
      EXPECT_TRUE(
          anyAt(all, i, distances[i], (2 * kSearchError * unit + rounding) / std::max(sine, 1e-6)))
          << name << ", " << textOf(rays.origins[i], rays.directions[i]) << " misses "
          << describe(at[i]) << " (sine " << sine << ")";
      EXPECT_LE(first.distance[row],
                distances[i] + (2 * kSearchError * unit + rounding) / std::max(sine, 1e-6))
          << name << ", " << textOf(rays.origins[i], rays.directions[i]) << " misses "
          << describe(at[i]);
    }
  }
}

void expectPointsAtGrazingAngles(int count) {
  Random random(3);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double unit = diagonalOf(surface);
    const std::vector<Location> at = searchedLocations(surface, count, random);
    const Evaluation e = surface.evaluate(at, Derivatives::first, true);
    Rays rays;
    std::vector<std::size_t> points;
    std::vector<double> angles;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Vector3 normal = e.normal.row(row);
      if (!normal.allFinite()) continue;
      for (const double angle : {1e-2, 1e-4, 1e-6, 1e-9, 0.}) {
        const Vector3 tangent = normal.cross(direction(random)).normalized();
        const Vector3 to = std::cos(angle) * tangent - std::sin(angle) * normal;
        rays.add(Vector3(e.position.row(row)) - 0.7 * unit * to, to);
        points.push_back(i);
        angles.push_back(angle);
      }
    }
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    const Hits first = search.rayCast(rays.originRows(), rays.directionRows());
    expectFirstOfAll(name, surface, rays, first, all);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // A ray along a tangent stays within the tolerance over a length of about its square root.
      const double slack = std::min(1e-4, 1e-11 / std::max(angles[i], 1e-11)) * unit;
      // A point on the border of a face may be on the border of the surface, which a ray at such an
      // angle may miss because of rounding; in a plane the ray meets the surface earlier.
      const Location& place = at[points[i]];
      const auto inside = [](double x) { return x > 1e-6 && x < 1 - 1e-6; };
      if (angles[i] < 1e-3 && !(inside(place.u) && inside(place.v))) continue;
      if (angles[i] < 1e-5 &&
          (runsWithin(all, i, rays.directions[i], 0.7 * unit) || isFlat(surface, place, unit))) {
        continue;
      }
      EXPECT_TRUE(anyAt(all, i, 0.7 * unit, std::max(slack, 2e-5 * unit * (angles[i] < 1e-5))))
          << name << ", " << textOf(rays.origins[i], rays.directions[i]) << " misses "
          << describe(at[points[i]]) << " at the angle " << angles[i];
    }
  }
}

TEST(RayCast, FindsPointsAtGrazingAngles) { expectPointsAtGrazingAngles(8); }

TEST(SlowRayCast, FindsPointsAtGrazingAngles) { expectPointsAtGrazingAngles(100); }

TEST(RayCast, MissesWhatItPasses) {
  // Rays outside a convex surface, along its tangent planes, and rays beside open boundaries.
  Random random(4);
  const Cage round = cube();
  const LimitSurface surface = limitSurface(round);
  const SurfaceSearch search(surface);
  const double unit = diagonalOf(surface);
  const std::vector<Location> at = searchedLocations(surface, 300, random);
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  Rays outside, inside;
  for (Eigen::Index i = 0; i < e.position.rows(); ++i) {
    const Vector3 point = e.position.row(i), normal = e.normal.row(i);
    const Vector3 tangent = normal.cross(direction(random)).normalized();
    outside.add(point + 1e-9 * unit * normal - 2 * unit * tangent, tangent);
    inside.add(point - 1e-9 * unit * normal - 2 * unit * tangent, tangent);
  }
  const Hits none = search.rayCast(outside.originRows(), outside.directionRows());
  const RayHits two = search.rayCastAll(inside.originRows(), inside.directionRows());
  for (std::size_t i = 0; i < outside.size(); ++i) {
    EXPECT_EQ(none.at[i].face, -1) << textOf(outside.origins[i], outside.directions[i]);
    EXPECT_EQ(two.offsets[i + 1] - two.offsets[i], 2)
        << textOf(inside.origins[i], inside.directions[i]);
  }
  for (const auto& [name, open] : NamedCages{{"cross", cross()},
                                             {"hexagon", ngon(6, 5)},
                                             {"mixture", mixture(3)},
                                             {"fan", fan(9, false, 16)}}) {
    // Across a boundary: a direction such as -du x n leads out of the surface.
    const LimitSurface sheet = limitSurface(open);
    const SurfaceSearch over(sheet);
    const double size = diagonalOf(sheet);
    for (const Location& b : searchedLocations(sheet, 200, random)) {
      const bool on_side = b.u == 0 || b.u == 1 || b.v == 0 || b.v == 1;
      const CornerPoints corners(open);
      if (!on_side || cornerAt(b) >= 0) continue;
      const Evaluation here = sheet.evaluate({&b, 1}, Derivatives::first, true);
      Vector3 out = b.u == 0 || b.u == 1 ? here.du.row(0) : here.dv.row(0);
      out *= b.u == 0 || b.v == 0 ? -1 : 1;
      const Vector3 along = b.u == 0 || b.u == 1 ? here.dv.row(0) : here.du.row(0);
      const Vector3 normal = here.normal.row(0);
      out = (out - out.dot(along) / along.squaredNorm() * along).normalized();
      if (!out.allFinite() || !normal.allFinite()) continue;
      const auto countAt = [&](double shift) {
        Rays ray;
        ray.add(Vector3(here.position.row(0)) + shift * size * out + 0.3 * size * normal, -normal);
        const RayHits hits = over.rayCastAll(ray.originRows(), ray.directionRows());
        return anyAt(hits, 0, 0.3 * size, 1e-6 * size);
      };
      // Only where no neighbouring face continues the surface.
      if (countAt(1e-4) || countAt(1e-6)) continue;
      EXPECT_FALSE(countAt(1e-8)) << name << ", " << describe(b);
      EXPECT_TRUE(countAt(-1e-9)) << name << ", " << describe(b);
      EXPECT_TRUE(countAt(0)) << name << ", " << describe(b);
    }
  }
}

TEST(RayCast, NoRayLeavesAClosedSurface) {
  Random random(5);
  for (const auto& [name, cage] : closedCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    // A point inside the surface: between two hits of a ray.
    Rays probe;
    for (int i = 0; i < 20; ++i) {
      const Vector3 to = direction(random);
      probe.add(middleOf(surface) + 0.05 * diagonalOf(surface) * random.vector(1) - 10 * to, to);
    }
    const RayHits through = search.rayCastAll(probe.originRows(), probe.directionRows());
    Vector3 inside = Vector3::Constant(NAN);
    double thickest = 0;
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const std::int64_t row = through.offsets[i];
      if (through.offsets[i + 1] - row < 2) continue;
      const double thickness = through.distance[row + 1] - through.distance[row];
      if (thickness > thickest) {
        thickest = thickness;
        inside = ((through.position.row(row) + through.position.row(row + 1)) / 2).transpose();
      }
    }
    ASSERT_GT(thickest, 0) << name;
    Rays rays;
    for (int i = 0; i < 3000; ++i) rays.add(inside, direction(random));
    // Rays towards all kinds of places at which faces meet.
    const Points targets = surface.evaluate(searchedLocations(surface, 3000, random)).position;
    for (Eigen::Index i = 0; i < targets.rows(); ++i) {
      rays.add(inside, targets.row(i).transpose() - inside);
    }
    const Hits hits = search.rayCast(rays.originRows(), rays.directionRows());
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    long even = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_GE(hits.at[i].face, 0) << name << ", " << textOf(rays.origins[i], rays.directions[i]);
      bool transversal = true;
      for (std::int64_t row = all.offsets[i]; row < all.offsets[i + 1]; ++row) {
        const double sine = std::abs(rays.directions[i].normalized().dot(all.normal.row(row)));
        transversal = transversal && sine > 1e-4;
      }
      // A ray may touch sharp edges and corners, so hits there are counted on smooth cages only.
      const bool sharp =
          !cage.options.edge_sharpness.edges.empty() || cage.options.scheme == Scheme::bilinear;
      if (!transversal || (sharp && i >= 3000)) continue;
      const bool is_even = (all.offsets[i + 1] - all.offsets[i]) % 2 == 0;
      even += is_even;
      EXPECT_FALSE(is_even) << name << ", " << textOf(rays.origins[i], rays.directions[i]);
    }
    EXPECT_EQ(even, 0) << name;
  }
}

TEST(RayCast, InAPlaneOfTheSurface) {
  // Rays within a plane sheet, along a generator, along a crease, and along an edge.
  Random random(6);
  for (const auto& [name, cage] : NamedCages{{"plane", grid(4, 3)},
                                             {"holes", gridWithHoles(5, 4, {6, 12})},
                                             {"prism", prism(8, false)},
                                             {"square", gridWithHoles(2, 1, {1})}}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double unit = diagonalOf(surface);
    const bool plane = cage.positions.col(2).isZero();
    Rays rays;
    const Evaluation e =
        surface.evaluate(searchedLocations(surface, 60, random), Derivatives::first, true);
    for (Eigen::Index i = 0; i < e.position.rows(); ++i) {
      Vector3 to =
          plane ? Vector3(random.uniform(-1, 1), random.uniform(-1, 1), 0) : Vector3(0, 0, 1);
      if (plane && i % 3 == 0) to = Vector3::Unit(i % 2);
      rays.add(Vector3(e.position.row(i)) - 3 * unit * to.normalized(), to);
    }
    const Hits first = search.rayCast(rays.originRows(), rays.directionRows());
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    expectFirstOfAll(name, surface, rays, first, all);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::string where = name + ", " + textOf(rays.origins[i], rays.directions[i]);
      EXPECT_GE(first.at[i].face, 0) << where;
      EXPECT_LE(first.distance[static_cast<Eigen::Index>(i)], 3 * unit * (1 + 1e-9)) << where;
    }
  }
}

TEST(RayCast, FirstHitOfARayInAPlaneIsWhereItEnters) {
  // The square [0, 1]^2 with pinned corners: the sheet begins at x = 0.
  Cage cage = grid(1, 1);
  cage.options.boundary = Boundary::corners;
  cage.options.scheme = Scheme::bilinear;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  Rays rays;
  rays.add({-2, 0.4, 0}, {1, 0, 0});
  rays.add({-2, 0, 0}, {1, 0, 0});
  rays.add({0.3, 5, 0}, {0, -1, 0});
  rays.add({-1, -1, 0}, {1, 1, 0});
  rays.add({0.5, 0.5, 0}, {1, 0.2, 0});
  const Hits hits = search.rayCast(rays.originRows(), rays.directionRows());
  const double expected[] = {2, 2, 4, std::sqrt(2.), 0};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(hits.distance[i], expected[i], 1e-11) << i;
}

TEST(RayCast, CoincidentSheetsCountEach) {
  Cage cage = perturbed(grid(3, 3), 0.1, 3);
  const int vertices = cage.vertexCount();
  const std::size_t faces = cage.faces.size();
  for (std::size_t f = 0; f < faces; ++f) {
    cage.faces.push_back(cage.faces[f]);
    for (int& vertex : cage.faces.back()) vertex += vertices;
  }
  const Points one = cage.positions;
  cage.positions.resize(2 * vertices, 3);
  cage.positions << one, one;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  Random random(7);
  int on_borders = 0;
  for (const Location& at : searchedLocations(surface, 400, random)) {
    const Evaluation e = surface.evaluate({&at, 1}, Derivatives::first, true);
    if (!e.normal.allFinite()) continue;
    Rays rays;
    rays.add((e.position + 0.5 * e.normal).transpose(), -e.normal.transpose());
    const RayHits hits = search.rayCastAll(rays.originRows(), rays.directionRows());
    const bool on_border = at.u * (1 - at.u) * at.v * (1 - at.v) == 0;
    on_borders += on_border;
    EXPECT_EQ(hits.at.size(), 2u) << describe(at);
  }
  EXPECT_GT(on_borders, 50);
}

TEST(RayCast, BeginsAtItsOrigin) {
  // A ray that begins on the surface hits it at distance 0, nothing behind it, and the far side of
  // a closed surface.
  Random random(8);
  const LimitSurface surface = limitSurface(perturbed(cube(), 0.2, 1));
  const SurfaceSearch search(surface);
  const double unit = diagonalOf(surface);
  const std::vector<Location> at = searchedLocations(surface, 400, random);
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3 point = e.position.row(row), normal = e.normal.row(row);
    Rays rays;
    rays.add(point, direction(random));
    rays.add(point + 1e-9 * unit * normal, normal);
    rays.add(point - 1e-9 * unit * normal, -normal);
    const Hits hits = search.rayCast(rays.originRows(), rays.directionRows());
    EXPECT_LE(hits.distance[0], kSearchError * unit) << describe(at[i]);
    EXPECT_GE(hits.at[0].face, 0);
    EXPECT_TRUE(hits.at[1].face < 0 || hits.distance[1] > 1e-6 * unit) << describe(at[i]);
    EXPECT_GT(hits.distance[2], 1e-6 * unit) << describe(at[i]);
  }
}

TEST(RayCast, KeepsToTheGreatestDistance) {
  Random random(9);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Rays rays = raysAround(surface, 10, random);
    const double slack = 4 * kSearchError * diagonalOf(surface) + 1e-13 * diagonalOf(surface);
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Points from = rays.origins[i].transpose(), to = rays.directions[i].transpose();
      for (std::int64_t row = all.offsets[i]; row < all.offsets[i + 1]; ++row) {
        if (std::abs(rays.directions[i].normalized().dot(all.normal.row(row))) < 1e-3) break;
        const double distance = all.distance[row];
        const auto before = static_cast<std::size_t>(row - all.offsets[i]);
        EXPECT_GE(search.rayCastAll(from, to, distance + slack).at.size(), before + 1) << name;
        EXPECT_LE(search.rayCastAll(from, to, distance - slack).at.size(), before) << name;
        if (before == 0) {
          EXPECT_EQ(search.rayCast(from, to, distance - slack).at[0].face, -1) << name;
          EXPECT_GE(search.rayCast(from, to, distance + slack).at[0].face, 0) << name;
        }
      }
    }
  }
}

TEST(RayCast, DirectionsOfAnyLengthAndAlongTheAxes) {
  const LimitSurface surface = limitSurface(cube());
  const SurfaceSearch search(surface);
  Points from(1, 3), to(1, 3);
  from << 0.45, 0.55, -3;
  to << 0, 0, 1;
  const Hits unit = search.rayCast(from, to);
  ASSERT_GE(unit.at[0].face, 0);
  for (const double length : {1e-300, 1e-200, 1e-20, 7., 1e20, 1e200, 1e300}) {
    const Hits hits = search.rayCast(from, length * to);
    EXPECT_EQ(hits.distance[0], unit.distance[0]) << length;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1., 1.}) {
      // Rays through the middles of faces, along edges of patches, and with negative zeros.
      for (const double aside : {0.5, 0.43, 0.25, 1. / 3}) {
        from.setConstant(aside);
        to.setConstant(-0.);
        from(0, axis) = 0.5 - 4 * sign;
        to(0, axis) = sign;
        EXPECT_EQ(search.rayCastAll(from, to).at.size(), 2u) << axis << " " << sign << " " << aside;
      }
    }
  }
}

TEST(RayCast, AtAnyScaleAndFarFromTheOrigin) {
  NamedCages cages;
  for (const double factor : {1e-30, 1e-12, 1e12, 1e30}) {
    cages.emplace_back("cube times " + std::to_string(factor),
                       placed(perturbed(cube(), 0.2, 1), factor));
    cages.emplace_back("mixture times " + std::to_string(factor), placed(mixture(3), factor));
  }
  compareWithBruteForce(cages, 40, 16);
  Random random(10);
  const Cage far = placed(perturbed(cube(), 0.2, 1), 1, {1e6, -2e6, 5e5});
  const LimitSurface surface = limitSurface(far);
  const SurfaceSearch search(surface);
  const Rays rays = raysAround(surface, 300, random);
  const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
  expectFirstOfAll("far cube", surface, rays,
                   search.rayCast(rays.originRows(), rays.directionRows()), all);
}

TEST(RayCast, DegenerateCagesEnd) {
  Random random(11);
  for (const auto& [name, cage] : degenerateCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Points targets = surface.evaluate(searchedLocations(surface, 10, random)).position;
    Rays rays;
    for (Eigen::Index i = 0; i < targets.rows(); ++i) {
      const Vector3 to = direction(random);
      rays.add(Vector3(targets.row(i)) - 2 * to, to);
      rays.add(Vector3(targets.row(i)) - 2 * to, to + 0.1 * direction(random));
      rays.add(Vector3(targets.row(i)) - 2 * Vector3::UnitX(), Vector3::UnitX());
    }
    const Hits first = search.rayCast(rays.originRows(), rays.directionRows());
    const RayHits all = search.rayCastAll(rays.originRows(), rays.directionRows());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(first.at[i].face >= 0, all.offsets[i] < all.offsets[i + 1])
          << name << ", " << textOf(rays.origins[i], rays.directions[i]);
    }
  }
}

TEST(RayCast, BitsDependNeitherOnThreadsNorOnTheBatch) {
  Random random(12);
  for (const Cage& cage : {perturbed(cube(), 0.2, 1), mixture(3), pole(100)}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Rays rays = raysAround(surface, 500, random);
    const Points from = rays.originRows(), to = rays.directionRows();
    const RayHits all = search.rayCastAll(from, to);
    for (const int threads : {1, 3}) {
      const RayHits other = search.rayCastAll(from, to, kInfinity, threads);
      EXPECT_TRUE(other.offsets == all.offsets && other.position == all.position &&
                  other.distance == all.distance);
      const Hits first = search.rayCast(from, to, kInfinity, threads);
      for (std::size_t i = 0; i < rays.size(); i += 9) {
        const auto row = static_cast<Eigen::Index>(i);
        const Hits one = search.rayCast(from.row(row), to.row(row));
        EXPECT_EQ(one.at[0].face, first.at[i].face);
        if (one.at[0].face < 0) continue;
        EXPECT_TRUE(one.position.row(0) == first.position.row(row) &&
                    one.distance[0] == first.distance[row] && one.at[0].u == first.at[i].u &&
                    one.at[0].v == first.at[i].v);
      }
    }
  }
}

TEST(RayCast, TellsWhatIsWrongWithItsArguments) {
  const LimitSurface surface = limitSurface(cube());
  const SurfaceSearch search(surface);
  Points from = Points::Zero(3, 3), to = Points::Ones(3, 3);
  using Error = std::invalid_argument;
  const auto cast = [&](double max_distance = kInfinity, int threads = 0) {
    return [&, max_distance, threads] { search.rayCast(from, to, max_distance, threads); };
  };
  const auto castAll = [&] { search.rayCastAll(from, to); };
  from(2, 1) = NAN;
  expectThrow<Error>(cast(), {"row 2", "origin", "finite"});
  expectThrow<Error>(castAll, {"row 2", "origin", "finite"});
  from(2, 1) = 0;
  to(1, 0) = kInfinity;
  expectThrow<Error>(cast(), {"row 1", "direction", "finite"});
  to.row(1).setZero();
  expectThrow<Error>(cast(), {"row 1", "direction", "length"});
  expectThrow<Error>(castAll, {"row 1", "direction", "length"});
  to.row(1).setOnes();
  expectThrow<Error>(cast(-1), {"max_distance"});
  expectThrow<Error>(cast(NAN), {"max_distance"});
  expectThrow<Error>(cast(1, -2), {"threads", "-2"});
  to = Points::Ones(2, 3);
  expectThrow<Error>(cast(), {"directions", "2", "3"});
  EXPECT_EQ(search.rayCast(Points(0, 3), Points(0, 3)).at.size(), 0u);
  EXPECT_EQ(search.rayCastAll(Points(0, 3), Points(0, 3)).offsets, std::vector<std::int64_t>{0});
}

}  // namespace
}  // namespace limitsurf::test
