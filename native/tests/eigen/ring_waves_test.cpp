// SPDX-License-Identifier: Apache-2.0
//
// The sums over a ring that give the coefficients of its modes: their error, against the same sums
// in double-doubles, and their cost, by the number of multiplications.
#include "limitsurf/eigen/ring_waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "limitsurf/eigen/circle.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

constexpr Ring kRings[] = {
    {RingKind::interior, 3},   {RingKind::interior, 128},  {RingKind::interior, 129},
    {RingKind::interior, 256}, {RingKind::interior, 1021}, {RingKind::dart, 360},
    {RingKind::boundary, 1},   {RingKind::boundary, 128},  {RingKind::boundary, 129},
    {RingKind::pinned, 256},   {RingKind::boundary, 1021},
};

/// One period of cosines and sines.
struct Tables {
  std::vector<SineCosine<DoubleDouble>> wide;
  std::vector<double> cos, sin;

  explicit Tables(const Ring& ring) {
    const std::int64_t period = (ring.closed() ? 2 : 4) * std::int64_t{ring.faces};
    wide = Circle<DoubleDouble>(period).first(period);
    for (const auto& at : wide) {
      cos.push_back(static_cast<double>(at.cos));
      sin.push_back(static_cast<double>(at.sin));
    }
  }
  const SineCosine<DoubleDouble>& at(std::int64_t i) const {
    return wide[static_cast<std::size_t>(i) % wide.size()];
  }
};

int modeCount(const Ring& ring) { return ring.closed() ? ring.faces / 2 : ring.faces; }

/// Zero on the spokes that bound a sector.
std::vector<double> randomPoints(const Ring& ring) {
  Random random(ring.faces);
  std::vector<double> points;
  for (int i = 0; i < ring.size(); ++i) points.push_back(random.vector(1)[0]);
  if (!ring.closed()) points[ring.edge(0)] = points[ring.edge(ring.faces)] = 0;
  return points;
}

RingWaves::Sums<double> exactSums(const Ring& ring, const Tables& tables,
                                  const std::vector<double>& points, int m) {
  DoubleDouble sums[4] = {0, 0, 0, 0};
  for (int i = 0; i < ring.edges(); ++i) {
    const auto& wave = tables.at(2 * std::int64_t{m} * i);
    sums[0] += wave.cos.times(points[ring.edge(i)]);
    sums[1] += wave.sin.times(points[ring.edge(i)]);
  }
  for (int j = 0; j < ring.faces; ++j) {
    const auto& wave = tables.at((2 * std::int64_t{j} + 1) * m);
    sums[2] += wave.cos.times(points[ring.face(j)]);
    sums[3] += wave.sin.times(points[ring.face(j)]);
  }
  return {static_cast<double>(sums[0]), static_cast<double>(sums[1]), static_cast<double>(sums[2]),
          static_cast<double>(sums[3])};
}

TEST(RingWaves, AreSummedToTheirLastDigits) {
  for (const Ring& ring : kRings) {
    const Tables tables(ring);
    const std::vector<double> points = randomPoints(ring);
    // A coefficient of a mode is a sum over this.
    const double bound = 2e-16 * ring.faces;
    int modes = 0;
    RingWaves(ring, tables.cos, tables.sin)
        .sums<double>(
            modeCount(ring), [&](int i) { return points[i]; },
            [&](int m, const RingWaves::Sums<double>& sums) {
              EXPECT_EQ(m, ++modes);
              const auto exact = exactSums(ring, tables, points, m);
              EXPECT_NEAR(sums.edge_sin, exact.edge_sin, bound) << ring.faces << ", mode " << m;
              EXPECT_NEAR(sums.face_sin, exact.face_sin, bound) << ring.faces << ", mode " << m;
              if (ring.closed() && ring.kind != RingKind::dart) {
                EXPECT_NEAR(sums.edge_cos, exact.edge_cos, bound) << ring.faces << ", mode " << m;
                EXPECT_NEAR(sums.face_cos, exact.face_cos, bound) << ring.faces << ", mode " << m;
              }
            });
    EXPECT_EQ(modes, modeCount(ring));
  }
}

/// Weights of mode m, as they may be on a ring of its kind.
RingWaves::Sums<double> randomWeights(const Ring& ring, int m) {
  Random random(m);
  const Vector3 a = random.vector(1), b = random.vector(1);
  const bool has_cosines = ring.closed() && ring.kind != RingKind::dart;
  return {has_cosines ? a[0] : 0, a[1], has_cosines ? a[2] : 0, b[0]};
}

TEST(RingWaves, AreSpreadToTheirLastDigits) {
  for (const Ring& ring : kRings) {
    const Tables tables(ring);
    const RingWaves waves(ring, tables.cos, tables.sin);
    EXPECT_EQ(waves.hasTransform(), ring.faces > 128);
    if (!waves.hasTransform()) continue;
    std::vector<DoubleDouble> exact(static_cast<std::size_t>(ring.size()), 0);
    for (int m = 1; m <= modeCount(ring); ++m) {
      const auto weight = randomWeights(ring, m);
      for (int i = 0; i < ring.edges(); ++i) {
        const auto& wave = tables.at(2 * std::int64_t{m} * i);
        exact[ring.edge(i)] += wave.cos.times(weight.edge_cos) + wave.sin.times(weight.edge_sin);
      }
      for (int j = 0; j < ring.faces; ++j) {
        const auto& wave = tables.at((2 * std::int64_t{j} + 1) * m);
        exact[ring.face(j)] += wave.cos.times(weight.face_cos) + wave.sin.times(weight.face_sin);
      }
    }
    int points = 0;
    waves.transposedSums<double>(
        modeCount(ring), [&](int m) { return randomWeights(ring, m); },
        [&](int point, double sum) {
          ++points;
          EXPECT_NEAR(sum, static_cast<double>(exact[point]), 2e-16 * ring.faces)
              << ring.faces << ", point " << point;
        });
    EXPECT_EQ(points, ring.size() - 1);
  }
}

/// A number that counts the products with it.
struct Counted {
  double value;
  static long products;

  friend Counted operator*(double a, const Counted& b) {
    ++products;
    return {a * b.value};
  }
  friend Counted operator+(const Counted& a, const Counted& b) { return {a.value + b.value}; }
  friend Counted operator-(const Counted& a, const Counted& b) { return {a.value - b.value}; }
  Counted operator-() const { return {-value}; }
  Counted& operator+=(const Counted& other) { return *this = *this + other; }
};
long Counted::products = 0;

long products(const Ring& ring) {
  const Tables tables(ring);
  const std::vector<double> points = randomPoints(ring);
  const RingWaves waves(ring, tables.cos, tables.sin);
  Counted::products = 0;
  waves.sums<Counted>(
      modeCount(ring), [&](int i) { return Counted{points[i]}; }, [](int, const auto&) {});
  return Counted::products;
}

// Sums one by one take 4 N^2 products in a sector: 1.6e9 for N = 20,000.
TEST(RingWaves, CostLittleMoreThanProportionallyToTheFaces) {
  for (const RingKind kind : {RingKind::interior, RingKind::pinned}) {
    for (const int faces : {129, 256, 257, 1000, 4093, 20000}) {
      EXPECT_LE(static_cast<double>(products({kind, faces})), 64 * faces * std::log2(faces))
          << faces;
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
