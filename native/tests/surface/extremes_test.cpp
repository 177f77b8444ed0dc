// SPDX-License-Identifier: Apache-2.0
//
// The smallest (u, v), the largest valences, the largest and smallest coordinates.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

const std::vector<double> kTiny = {1e-30, 1e-100, 1e-200, 1e-300, 0x1p-1022, 0x1p-1060, 0x1p-1074};

/// Fans of all kinds with the vertex at (0, 0) of face 0.
std::vector<std::pair<std::string, Cage>> someFans() {
  std::vector<std::pair<std::string, Cage>> result;
  for (int faces : {3, 4, 5, 6, 7, 12, 40}) {
    result.emplace_back("interior, " + std::to_string(faces) + " faces", fan(faces, true, faces));
  }
  for (int faces : {1, 2, 3, 4, 5, 6, 7, 8, 12, 40}) {
    Cage cage = fan(faces, false, faces);
    result.emplace_back("smooth boundary, " + std::to_string(faces) + " faces", cage);
    cage.options.boundary = Boundary::corners;
    result.emplace_back("pinned boundary, " + std::to_string(faces) + " faces", cage);
  }
  return result;
}

TEST(Extremes, TinyUvApproachTheVertex) {
  for (const auto& [name, cage] : someFans()) {
    const LimitSurface surface = limitSurface(cage);
    const int last = static_cast<int>(cage.faces.size()) - 4;
    for (int face : {0, last}) {
      std::vector<Location> at = {{face, 0, 0}};
      for (double t : kTiny) {
        at += {{face, t, t}, {face, t, t / 2}, {face, t / 4, t}, {face, t, 0}, {face, 0, t}};
      }
      for (Derivatives order : kOrders) {
        const Evaluation e = surface.evaluate(at, order);
        const Vector3 vertex = e.position.row(0);
        for (int i = 1; i < static_cast<int>(at.size()); ++i) {
          const std::string where =
              name + ", " + describe(at[i]) + ", order " + std::to_string(static_cast<int>(order));
          EXPECT_LE((e.position.row(i).transpose() - vertex).norm(),
                    kPositionError * diagonal(cage.positions))
              << where;
          const Truth got = rowOf(e, i);
          if (order == Derivatives::none) continue;
          EXPECT_TRUE(got[kDu].allFinite() && got[kDv].allFinite()) << where;
          if (order == Derivatives::first) continue;
          for (int second : {kDuu, kDuv, kDvv}) {
            EXPECT_FALSE(got[second].hasNaN()) << where;
            // They grow by up to 2.62 with each level, so that the truth overflows before 2^-1000.
            EXPECT_TRUE(got[second].allFinite() || at[i].u + at[i].v < 1e-200) << where;
          }
        }
      }
      EXPECT_TRUE(surface.frames(at).allFinite()) << name;
    }
  }
}

TEST(Extremes, MinusZeroIsZero) {
  for (const Cage& cage : {fan(5, true, 1), fan(4, false, 1), fan(2, false, 1), cube()}) {
    const LimitSurface surface = limitSurface(cage);
    std::vector<Location> zero, minus;
    for (int face = 0; face < surface.faceCount(); ++face) {
      for (const double other : {0., 0x1p-60, 0.3, 1.}) {
        zero.insert(zero.end(), {{face, 0, other}, {face, other, 0}});
        minus.insert(minus.end(), {{face, -0., other}, {face, other, -0.}});
      }
      zero.push_back({face, 0, 0});
      minus.push_back({face, -0., -0.});
    }
    const auto same = [](const Points& a, const Points& b) {
      return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
    };
    for (const Derivatives order : {Derivatives::none, Derivatives::first, Derivatives::second}) {
      const bool normals = order != Derivatives::none;
      const Evaluation a = surface.evaluate(zero, order, normals);
      const Evaluation b = surface.evaluate(minus, order, normals);
      EXPECT_TRUE(same(a.position, b.position)) << static_cast<int>(order);
      EXPECT_TRUE(same(a.du, b.du) && same(a.dv, b.dv) && same(a.normal, b.normal));
      EXPECT_TRUE(same(a.duu, b.duu) && same(a.duv, b.duv) && same(a.dvv, b.dvv));
    }
  }
}

TEST(Extremes, TinyUvHaveNormals) {
  // The surface is smooth everywhere but at the vertex itself.
  for (const auto& [name, cage] : someFans()) {
    std::vector<Location> at;
    for (int face : {0, static_cast<int>(cage.faces.size()) - 4}) {
      for (double t : kTiny) at += {{face, t, t}, {face, t, t / 2}, {face, t, 0}, {face, 0, t}};
    }
    const Evaluation e = limitSurface(cage).evaluate(at, Derivatives::first, true);
    int missing = 0;
    std::string first;
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      if (std::abs(e.normal.row(i).norm() - 1) <= 1e-12) continue;
      if (missing++ == 0) first = describe(at[i]);
    }
    EXPECT_EQ(missing, 0) << name << ": of " << at.size() << " normals, the first at " << first;
  }
}

TEST(Extremes, DeepDerivativesAgreeWithSubdivision) {
  // At depths far below those for which bounds are promised, the powers of the eigenvalues must not
  // lose their digits.
  for (const auto& [faces, closed] :
       {std::pair(3, true), {5, true}, {7, true}, {1, false}, {3, false}, {4, false}}) {
    const Cage cage = fan(faces, closed, faces);
    const LimitSurface surface = limitSurface(cage);
    DeepSubdivision deep(cage);
    const std::vector<Location> at = {
        {0, 0x1p-60, 0x1p-61}, {0, 0x1p-100, 0x1p-101}, {0, 0x1p-200, 0x1p-200}};
    for (Derivatives order : {Derivatives::first, Derivatives::second}) {
      const Evaluation e = surface.evaluate(at, order);
      for (int i = 0; i < static_cast<int>(at.size()); ++i) {
        const Truth got = rowOf(e, i), truth = deep.evaluate(at[i]);
        for (int quantity : {kDu, kDv}) {
          // The error is relative to the value itself, however large or small that is.
          EXPECT_LE((got[quantity] - truth[quantity]).norm(), 1e-10 * truth[quantity].norm())
              << faces << (closed ? " faces, " : " faces at a boundary, ") << describe(at[i])
              << ", " << kQuantityNames[quantity] << ", order " << static_cast<int>(order)
              << ": is " << got[quantity].transpose() << ", should be "
              << truth[quantity].transpose();
        }
      }
    }
  }
}

TEST(Extremes, ScalesOfTheCageDoNotMatter) {
  const Cage cage = mixture(3);
  Random random(1);
  std::vector<Location> at;
  for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
    at += anywhere(face, 2, random);
    at += shells(face, 0, {1, 10, 30});
  }
  const Evaluation plain = limitSurface(cage).evaluate(at, Derivatives::second, true);
  for (int exponent : {-300, -60, 60, 300}) {
    Cage scaled = cage;
    scaled.positions *=
        std::ldexp(1.0, exponent);  // nothing is rounded, so that only exponents change
    const Evaluation e = limitSurface(scaled).evaluate(at, Derivatives::second, true);
    const double back = std::ldexp(1.0, -exponent);
    EXPECT_EQ(e.position * back, plain.position) << "2^" << exponent;
    EXPECT_EQ(e.du * back, plain.du) << "2^" << exponent;
    EXPECT_EQ(e.dvv * back, plain.dvv) << "2^" << exponent;
    EXPECT_LE((e.normal - plain.normal).cwiseAbs().maxCoeff(), 1e-14) << "2^" << exponent;
  }
}

/// Makes the surface, prints how long that takes, and compares positions with subdivision.
void openAndCompare(const std::string& name, const Cage& cage, const std::vector<Location>& at,
                    double error) {
  const auto start = std::chrono::steady_clock::now();
  const LimitSurface surface = limitSurface(cage);
  const std::chrono::duration<double> opening = std::chrono::steady_clock::now() - start;
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  const std::chrono::duration<double> both = std::chrono::steady_clock::now() - start;
  DeepSubdivision deep(cage);
  double worst = 0;
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const Vector3 truth = deep.evaluate(at[i])[kPosition];
    worst = std::max(worst, (e.position.row(i).transpose() - truth).norm());
  }
  worst /= diagonal(cage.positions);
  std::printf("  %s: opened in %.3f s, %zu locations in %.3f s, worst position %.1e\n",
              name.c_str(), opening.count(), at.size(), (both - opening).count(), worst);
  EXPECT_LE(worst, error) << name;
}

TEST(Extremes, ValenceThousandIsAnOrdinaryVertex) {
  const std::vector<Location> at = {
      {0, 0.3, 0.2}, {0, 0.01, 0.02}, {2000, 1e-4, 1e-5}, {3996, 0x1p-30, 0x1p-30}};
  openAndCompare("interior valence 1000", fan(1000, true, 1), at, 1e-12);
  openAndCompare("boundary valence 1001", fan(1000, false, 1), at, 1e-12);
}

TEST(Extremes, PolygonsOfAThousandSidesAreOrdinary) {
  const std::vector<Location> at = {
      {0, 0.3, 0.2}, {0, 0.99, 0.98}, {500, 1 - 1e-4, 1 - 1e-5}, {999, 1 - 0x1p-30, 1 - 0x1p-30}};
  openAndCompare("polygon of 1000 sides", ngon(1000, 1), at, 1e-12);
}

TEST(SlowExtremes, ValenceTenThousandOpens) {
  const std::vector<Location> at = {{0, 0.3, 0.2}, {29997, 0.01, 0.02}, {15000, 0.999, 1}};
  openAndCompare("pole of 10,000 triangles", pole(10000), at, 1e-11);
}

TEST(Extremes, MoreThan65535EdgesAreRefused) {
  EXPECT_THROW(limitSurface(pole(65536)), MeshError);
  Cage polygon;
  polygon.positions = Points::Random(65536, 3);
  polygon.faces.resize(1);
  for (int i = 0; i < 65536; ++i) polygon.faces[0].push_back(i);
  EXPECT_THROW(controlMesh(polygon), MeshError);
}

}  // namespace
}  // namespace limitsurf::test
