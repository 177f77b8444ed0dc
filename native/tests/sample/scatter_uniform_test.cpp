// SPDX-License-Identifier: Apache-2.0
//
// Uniform scattering: counts are compared with integrals of area, by quadrature of the evaluated
// surface.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "limitsurf/sample/area_sampler.h"
#include "support/cages/meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/random.h"
#include "support/throws.h"
#include "support/truth/scatter_witness.h"

namespace limitsurf::test {
namespace {

/// A correct sampler exceeds this once in a few million tests.
constexpr double kMostDeviations = 5;
constexpr int kSide = 4, kPoints = 24;

bool same(const std::vector<Location>& a, const std::vector<Location>& b, std::size_t count) {
  return a.size() >= count && b.size() >= count &&
         std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(count), b.begin(),
                    [](const Location& x, const Location& y) {
                      return x.face == y.face && x.u == y.u && x.v == y.v;
                    });
}

Eigen::VectorXd randomWeights(const Cage& cage, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd weights(cage.vertexCount());
  for (double& weight : weights) weight = random.below(3) == 0 ? 0 : random.uniform(0, 2);
  return weights;
}

/// The weights of vertices at a location, by their definition.
double weightAt(const Cage& cage, const Eigen::VectorXd& weights, const Location& at) {
  const PtexFace ptex = ptexFaces(cage)[at.face];
  const std::vector<int>& face = cage.faces[ptex.base_face];
  const int sides = static_cast<int>(face.size());
  double corners[4];  // in the order (0,0), (1,0), (1,1), (0,1)
  if (ptex.quad) {
    for (int i = 0; i < 4; ++i) corners[i] = weights[face[i]];
  } else {
    const double own = weights[face[ptex.corner]];
    corners[0] = own;
    corners[1] = (own + weights[face[(ptex.corner + 1) % sides]]) / 2;
    corners[3] = (own + weights[face[(ptex.corner + sides - 1) % sides]]) / 2;
    corners[2] = 0;
    for (const int vertex : face) corners[2] += weights[vertex] / sides;
  }
  return (1 - at.v) * ((1 - at.u) * corners[0] + at.u * corners[1]) +
         at.v * ((1 - at.u) * corners[3] + at.u * corners[2]);
}

TEST(SlowScatterUniform, IsUniformByAreaWithinFacesToo) {
  for (const auto& [name, cage] : NamedCages{{"all kinds", scatteredCage()},
                                             {"pole of valence 23", bent(pole(23))},
                                             {"boundary valence 8", bent(fan(7, false, 2))},
                                             {"corner", bent(fan(1, false, 3))},
                                             {"valence 2", bent(valenceTwo())},
                                             {"cube", cube()}}) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = AreaSampler(surface).uniform(1000000, 11);
    ASSERT_EQ(at.size(), 1000000u);
    const std::vector<double> expected = areas(surface, kSide, kPoints);
    EXPECT_LT(std::abs(chiSquareDeviation(counts(surface, at, kSide), expected)), kMostDeviations);
  }
}

/// Close to an extraordinary vertex, where the surface consists of ever smaller patches.
TEST(ScatterUniform, IsUniformByAreaAroundExtraordinaryVertices) {
  const int faces = 30;
  const LimitSurface surface = limitSurface(fan(faces, true, 4));
  const std::vector<Location> at = AreaSampler(surface).uniform(3000000, 1);
  // Rings 2^-n-1 <= max(u, v) < 2^-n of the faces around vertex 0, their areas by quadrature.
  const int rings = 10, points = 40;
  std::vector<double> count(rings, 0), area(rings, 0);
  for (const Location& location : at) {
    const double size = std::max(location.u, location.v);
    if (location.face % 4 == 0 && size < 1 && size >= std::ldexp(1, -rings)) {
      ++count[static_cast<int>(-std::ilogb(size)) - 1];
    }
  }
  for (int face = 0; face < 4 * faces; face += 4) {
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<Location> ats;
      for (int i = 0; i < points * points; ++i) {
        const double u = (i % points + 0.5) / points, v = (i / points + 0.5) / points;
        if (std::max(u, v) >= 0.5)
          ats.push_back({face, std::ldexp(u, -ring), std::ldexp(v, -ring)});
      }
      const Evaluation values = surface.evaluate(ats, Derivatives::first);
      for (Eigen::Index i = 0; i < values.du.rows(); ++i) {
        const Vector3 du = values.du.row(i), dv = values.dv.row(i);
        area[ring] += std::ldexp(du.cross(dv).norm(), -2 * ring);
      }
    }
  }
  EXPECT_LT(std::abs(chiSquareDeviation(count, area)), kMostDeviations);
  EXPECT_GT(count.back(), 10);
}

TEST(ScatterUniform, FollowsVertexWeights) {
  const Cage cage = scatteredCage();
  const LimitSurface surface = limitSurface(cage);
  const Eigen::VectorXd weights = randomWeights(cage, 8);
  const std::vector<Location> at =
      AreaSampler(surface).uniform(1000000, 2, Density(surface, weights));
  ASSERT_EQ(at.size(), 1000000u);
  const std::vector<double> expected =
      areas(surface, kSide, kPoints, [&](const Location& l) { return weightAt(cage, weights, l); });
  EXPECT_LT(std::abs(chiSquareDeviation(counts(surface, at, kSide), expected)), kMostDeviations);
}

TEST(ScatterUniform, FollowsAFunction) {
  const LimitSurface surface = limitSurface(scatteredCage());
  const Weight weight = [](const Location& l) {
    return l.face % 3 == 0 ? 0 : l.u * l.u + 0.1 * (l.face % 5) * (1 - l.v);
  };
  const Density density([&](Span<Location> at, double* weights) {
    for (const Location& l : at) *weights++ = weight(l);
  });
  const std::vector<Location> at = AreaSampler(surface).uniform(1000000, 3, density);
  ASSERT_EQ(at.size(), 1000000u);
  EXPECT_LT(std::abs(chiSquareDeviation(counts(surface, at, kSide),
                                        areas(surface, kSide, kPoints, weight))),
            kMostDeviations);
}

/// The largest value lies where the function is not read at first.
TEST(ScatterUniform, FollowsAFunctionWithAPeak) {
  const LimitSurface surface = limitSurface(scatteredCage());
  const auto isPeak = [](const Location& l) {
    return l.face == 8 && l.u > 0.25 && l.u < 0.5 && l.v > 0.5 && l.v < 0.75;
  };
  const Weight weight = [&](const Location& l) { return isPeak(l) ? 8. : 1.; };
  const Density density([&](Span<Location> at, double* weights) {
    for (const Location& l : at) *weights++ = weight(l);
  });
  const AreaSampler sampler(surface);
  const std::vector<Location> at = sampler.uniform(200000, 3, density);
  EXPECT_LT(std::abs(chiSquareDeviation(counts(surface, at, kSide),
                                        areas(surface, kSide, kPoints, weight))),
            kMostDeviations);
  EXPECT_TRUE(same(at, sampler.uniform(200000, 3, density, 1), at.size()));
}

TEST(ScatterUniform, DependsOnSeedAndNumberAlone) {
  const Cage cage = scatteredCage();
  const LimitSurface surface = limitSurface(cage);
  const AreaSampler sampler(surface);
  for (const Density& density : {Density(), Density(surface, randomWeights(cage, 9))}) {
    const std::vector<Location> all = sampler.uniform(300000, 7, density);
    EXPECT_TRUE(same(all, sampler.uniform(300000, 7, density, 1), all.size()));
    EXPECT_TRUE(same(all, AreaSampler(surface, 1).uniform(300000, 7, density, 3), all.size()));
    EXPECT_TRUE(same(all, sampler.uniform(1000, 7, density), 1000));
    EXPECT_FALSE(same(all, sampler.uniform(1000, 8, density), 1));
  }
}

TEST(ScatterUniform, LeavesOutFacesWithoutASurface) {
  Cage cage = gridWithFace({0, 1, 2, 1});
  cage.options.holes = {3};
  const LimitSurface surface = limitSurface(cage);
  ASSERT_EQ(surface.refused().size(), 2u);
  const std::vector<Location> at = AreaSampler(surface).uniform(100000, 1);
  EXPECT_LT(
      std::abs(chiSquareDeviation(counts(surface, at, kSide), areas(surface, kSide, kPoints))),
      kMostDeviations);
}

TEST(ScatterUniform, GivesExactlyTheCount) {
  const LimitSurface surface = limitSurface(cross());
  const AreaSampler sampler(surface);
  for (const int count : {0, 1, 2, 17, 10000}) {
    EXPECT_EQ(static_cast<int>(sampler.uniform(count, 1).size()), count);
  }
}

TEST(ScatterUniform, RefusesWhatHasNoMeaning) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  const AreaSampler sampler(surface);
  const auto fails = [&](const Density& density, const std::vector<std::string>& parts) {
    expectThrow<std::invalid_argument>([&] { sampler.uniform(5, 1, density); }, parts);
  };
  const auto constant = [](double value) {
    return Density([value](Span<Location> at, double* weights) {
      std::fill(weights, weights + at.size(), value);
    });
  };
  expectThrow<std::invalid_argument>([&] { sampler.uniform(-1, 1); }, {"count", "-1"});
  fails(constant(-2), {"density", "-2", "face 0"});
  fails(constant(NAN), {"density", "nan", "face 0"});
  fails(constant(INFINITY), {"density", "inf", "face 0"});
  fails(constant(0), {"density", "0 at all of"});
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(cage.vertexCount());
  fails(Density(surface, weights), {"density is 0 everywhere"});
  weights[3] = -1;
  expectThrow<std::invalid_argument>([&] { Density(surface, weights); }, {"-1", "vertex 3"});
  expectThrow<std::invalid_argument>([&] { Density(surface, weights.head(4)); },
                                     {"4 weights", std::to_string(cage.vertexCount())});
}

TEST(ScatterUniform, NeedsASurface) {
  Cage cage = grid(2, 2);
  cage.options.holes = {0, 1, 2, 3};
  const LimitSurface none = limitSurface(cage);
  EXPECT_TRUE(AreaSampler(none).uniform(0, 1).empty());
  expectThrow<std::invalid_argument>([&] { AreaSampler(none).uniform(1, 1); }, {"no area"});
  Cage point = grid(2, 2);
  point.positions.setZero();
  const LimitSurface collapsed = limitSurface(point);
  expectThrow<std::invalid_argument>([&] { AreaSampler(collapsed).uniform(1, 1); }, {"no area"});
}

TEST(ScatterUniform, TellsItsProgressAndEndsWhenTold) {
  const LimitSurface surface = limitSurface(cross());
  const AreaSampler sampler(surface);
  double last = 0;
  int calls = 0;
  sampler.uniform(1000000, 1, {}, 0, [&](double part) {
    EXPECT_GE(part, last);
    last = part;
    ++calls;
  });
  EXPECT_EQ(last, 1);
  EXPECT_GE(calls, 5);
  const auto stop = [](double part) {
    if (part > 0.3) throw std::runtime_error("enough");
  };
  expectThrow<std::runtime_error>([&] { sampler.uniform(1000000, 1, {}, 0, stop); }, {"enough"});
}

}  // namespace
}  // namespace limitsurf::test
