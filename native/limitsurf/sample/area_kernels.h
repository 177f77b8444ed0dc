// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Squares of bicubic patches, side by side, for quadratures of |ds x dt|.
struct SquareBlock {
  static constexpr int kCount = 8;

  double points[3][16][kCount];  ///< the coordinates of each square's Bezier points, axis by axis

  void put(const BezierPatch& patch, int place) {
    for (int i = 0; i < 16; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        points[axis][i][place] = patch.points[i][axis];
      }
    }
  }
  /// The opposite of put(): sets the points of a patch.
  void get(int place, BezierPatch& patch) const {
    for (int i = 0; i < 16; ++i) {
      patch.points[i] = {points[0][i][place], points[1][i][place], points[2][i][place], 0};
    }
  }
  /// Fills a place with the square of another, since every place has to hold numbers.
  void copy(int from, int to) {
    for (int i = 0; i < 16; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        points[axis][i][to] = points[axis][i][from];
      }
    }
  }
};

/// What is known of each square of a block before any quadrature.
struct SquareShapes {
  double rounding[SquareBlock::kCount];  ///< more than the rounding errors of any quadrature
  /// Above 0 only if (ds x dt) n > 0 everywhere, n the normal in the middle.
  double upright[SquareBlock::kCount];
};

/// What a rule finds on each square of a block.
struct RuleResults {
  double area[SquareBlock::kCount];
  double normal[3][SquareBlock::kCount];  ///< the integral of ds x dt
  /// How fast the coefficients of an expansion in Legendre polynomials fall. What is expanded is
  /// |ds x dt| less its part along the mean normal, which all rules integrate exactly. These are
  /// the squared norms of the coefficients of degree PairedRule::kHighest along s or t, and of
  /// degree PairedRule::kLower.
  double highest[SquareBlock::kCount], lower[SquareBlock::kCount];
};

/// The mean of ds x dt on each square of a block, and how far it differs from that at most.
struct NormalBounds {
  double mean[3][SquareBlock::kCount];
  double reach[SquareBlock::kCount];
};

/// Quadratures and bounds, compiled for one instruction set. A square's results do not depend on
/// the set, nor on the other squares of its block.
struct AreaKernels {
  void (*shapes)(const SquareBlock& squares, SquareShapes& out);
  /// Gauss's rules with 4, 6 and 8 points a side.
  using Rule = void (*)(const SquareBlock& squares, RuleResults& out);
  Rule four, six, eight;

  /// Of the first `count` squares, an upper bound of |ds x dt|, an estimate of its mean, and a
  /// lower bound, which is above 0 only on squares that are bent little.
  void (*bounds)(const SquareBlock& squares, int count, double bounds[SquareBlock::kCount],
                 double means[SquareBlock::kCount], double least[SquareBlock::kCount]);
  void (*normals)(const SquareBlock& squares, int count, NormalBounds& out);

  /// For the instruction set in use.
  static const AreaKernels& get();
};

}  // namespace limitsurf
