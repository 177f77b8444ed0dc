// SPDX-License-Identifier: Apache-2.0
//
// Errors of areas that are stated, against areas by brute force in long double.
#include "limitsurf/sample/area_quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limitsurf/pi.h"
#include "limitsurf/sample/area.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

using Real = long double;

/// The rule of Gauss and Legendre on [0, 1], its points by Newton's method.
struct LongRule {
  static constexpr int kCount = 20;

  LongRule() {
    for (int i = 0; i < kCount; ++i) {
      Real z = std::cos(kPi<double> * (i + 0.75) / (kCount + 0.5)), slope = 1;
      for (int step = 0; step < 8; ++step) {
        Real p = 1, before = 0;
        for (int j = 0; j < kCount; ++j) {
          const Real next = ((2 * j + 1) * z * p - j * before) / (j + 1);
          before = p;
          p = next;
        }
        slope = kCount * (z * p - before) / (z * z - 1);
        z -= p / slope;
      }
      at[i] = (1 - z) / 2;
      weight[i] = 1 / ((1 - z * z) * slope * slope);
    }
  }

  Real at[kCount], weight[kCount];
};

/// |ds x dt| at (s, t) of a bicubic patch.
Real areaAt(const AreaSquare& square, Real s, Real t) {
  const auto bernstein = [](Real x, Real value[4], Real slope[4]) {
    const Real y = 1 - x;
    const Real values[4] = {y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
    const Real slopes[4] = {-3 * y * y, 3 * y * y - 6 * x * y, 6 * x * y - 3 * x * x, 3 * x * x};
    std::copy(values, values + 4, value);
    std::copy(slopes, slopes + 4, slope);
  };
  Real s_value[4], s_slope[4], t_value[4], t_slope[4], ds[3] = {}, dt[3] = {};
  bernstein(s, s_value, s_slope);
  bernstein(t, t_value, t_slope);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 16; ++i) {
      ds[axis] += s_slope[i % 4] * t_value[i / 4] * square.points[axis][i];
      dt[axis] += s_value[i % 4] * t_slope[i / 4] * square.points[axis][i];
    }
  }
  Real sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const Real product = ds[a] * dt[b] - ds[b] * dt[a];
    sum += product * product;
  }
  return std::sqrt(sum);
}

/// On halves in both directions, 40 points a side.
Real areaOf(const AreaSquare& square) {
  static const LongRule rule;
  Real sum = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int j = 0; j < LongRule::kCount; ++j) {
      for (int i = 0; i < LongRule::kCount; ++i) {
        sum += rule.weight[i] * rule.weight[j] / 4 *
               areaAt(square, (quarter % 2 + rule.at[i]) / 2, (quarter / 2 + rule.at[j]) / 2);
      }
    }
  }
  return sum;
}

/// Noise in the plane of a sheet, and across it, as a part of the width of its faces.
struct Noise {
  double along, across;
};

/// Two rules agree by accident on one patch in a few hundred of these.
TEST(AreaQuadrature, StatesNoErrorThatIsTooSmall) {
  for (const Noise noise : {Noise{0.02, 0.02}, Noise{0.05, 0.05}, Noise{0.1, 0.1}, Noise{0.1, 1e-3},
                            Noise{0.3, 0.01}, Noise{0.2, 0.2}}) {
    Cage cage = perturbed(grid(16, 16), noise.along, 7);
    cage.positions.col(2) *= noise.across / noise.along;
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 1, PatchUnit::own);
    std::vector<SurfacePiece> pieces;
    for (int tile = 0; tile < patches.tileCount(); ++tile) patches.appendPieces(tile, pieces);
    std::vector<AreaSquare> squares;
    for (const SurfacePiece& piece : pieces) {
      if (!piece.isCore()) squares.emplace_back(patches.patch(piece), kAreaError / 20, 0);
    }
    AreaQuadrature().measure(squares);
    for (const AreaSquare& square : squares) {
      const SurfaceArea stated = square.result();
      EXPECT_LE(std::abs(static_cast<double>(stated.value - areaOf(square))), stated.error)
          << noise.along << " " << noise.across;
    }
  }
}

/// A single face has nothing that would make up for its own error.
TEST(AreaQuadrature, StatesErrorsOfSingleFaces) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const LimitSurface surface = limitSurface(perturbed(grid(1, 1), 0.1, seed));
    const SurfacePatches patches(surface, 1);
    Real truth = 0;
    std::vector<SurfacePiece> pieces;
    for (int tile = 0; tile < patches.tileCount(); ++tile) patches.appendPieces(tile, pieces);
    SurfacePatches::SplitCore split;
    for (const SurfacePiece& piece : pieces) {
      if (!piece.isCore()) {
        truth += areaOf(AreaSquare(patches.patch(piece), 0, 0));
        continue;
      }
      split.core = piece;
      for (int step = 0; step < 24; ++step) {
        const SurfacePiece core = split.core;
        patches.split(core, split);
        for (const BezierPatch& patch : split.patches) truth += areaOf(AreaSquare(patch, 0, 0));
      }
    }
    const SurfaceArea area = measuredArea(surface, 1);
    EXPECT_LE(std::abs(static_cast<double>(area.value - truth)), area.error + 1e-14 * area.value)
        << seed;
  }
}

}  // namespace
}  // namespace limitsurf::test
