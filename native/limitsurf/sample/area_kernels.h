// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// Squares of bicubic patches, side by side, for quadratures of |ds x dt|.
struct SquareBlock {
  static constexpr int kCount = 8;

  double points[3][16][kCount];  ///< the coordinates of each square's Bezier points, axis by axis
};

/// What is computed of each square of a block at first.
struct FirstRules {
  double one[SquareBlock::kCount], two[SquareBlock::kCount], three[SquareBlock::kCount];  ///< areas
  double rounding[SquareBlock::kCount];  ///< more than the rounding errors of any quadrature
  /// Above 0 only if (ds x dt) n > 0 everywhere, n the normal in the middle.
  double upright[SquareBlock::kCount];
};

/// The quadratures of area(), compiled for one instruction set. A square's results do not depend on
/// the set, nor on the other squares of its block.
struct AreaKernels {
  /// Gauss's rules with 1, 2 and 3 points a side.
  void (*first_rules)(const SquareBlock& squares, FirstRules& out);
  /// The rules with 4, 6 and 8 points a side.
  using Rule = void (*)(const SquareBlock& squares, double areas[SquareBlock::kCount]);
  Rule four, six, eight;

  /// For the instruction set in use.
  static const AreaKernels& get();
};

}  // namespace limitsurf
