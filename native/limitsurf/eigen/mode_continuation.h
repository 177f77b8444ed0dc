// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/eigen/outer_modes.h"

namespace limitsurf {

/// Continues modes from the ring to the whole grid of a face, in double-doubles: the columns of U1
/// of Lacewell & Burley 2007, section 3.1, and the grid after a step.
class ModeContinuation {
 public:
  using Real = DoubleDouble;
  using Outer = OuterModes<Real>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, tile_grid::kOuter, 1>;
  using SlotValues = std::array<Real, tile_grid::kSlots>;

  struct Wide {  ///< a ModeTable before rounding
    Vector outer;
    SlotValues grid;
    Vector rest;  ///< what a step feeds from the mode into the outer modes
  };

  explicit ModeContinuation(Sides sides);

  /// The continuation for faces with these sides, which all eigenbases share. Thread-safe.
  static const ModeContinuation& of(Sides sides);

  const Outer& outer() const { return outer_; }

  /// The vector with the ring part `ring_values` that a step takes to lambda times itself plus
  /// `feeds` times the vector `fed`.
  Wide continued(Real lambda, const SlotValues& ring_values, Real feeds = 0,
                 const Wide* fed = nullptr) const;

  /// The same, where lambda is so close to the eigenvalue `met` of S12 that solving for the outer
  /// part would lose digits: the mode feeds the outer modes to `met` instead.
  Wide continuedBeside(Real lambda, Real met, const SlotValues& ring_values) const;

  /// The two vectors a and b that a step takes to mean a + forth b and to mean b + back a.
  std::array<Wide, 2> continuedPair(Real mean, Real forth, Real back,
                                    const std::array<SlotValues, 2>& ring_values) const;

  /// The function a x + b y, which a step halves. Its values are exact, so that its second
  /// derivatives are exactly 0.
  Wide linear(Real a, Real b) const;

  static ModeTable rounded(const Wide& wide);

 private:
  /// Fills the outer part y of a vector whose ring part is x: (S12 - lambda) y = -S11 x + rhs
  /// (Lacewell & Burley 2007, section 3.1); `right` is W1^-1 (-S11 x + rhs).
  ///
  /// The components of the right-hand side along the outer modes with eigenvalue `met` are not
  /// solved for but returned in wide.rest: a step takes (x, y) to lambda (x, y) + rhs + W1 rest.
  /// Where lambda equals an eigenvalue of S12, `met` has to be that eigenvalue; y has no component
  /// along its modes then, and `rest` is 0 except at interior valence 2.
  void solveOuter(Real lambda, Real met, const Vector& right, Wide& wide) const;
  /// -W1^-1 S11 x.
  Vector fromRing(const SlotValues& ring_values) const;
  /// W1 z.
  Vector outerPart(const Vector& z) const;
  /// Fills wide.grid with the grid after one step, whose ring part is `next_ring`.
  void stepGrid(const SlotValues& ring_values, const SlotValues& next_ring, Wide& wide) const;

  Outer outer_;
  Eigen::Matrix<Real, Eigen::Dynamic, static_cast<int>(tile_grid::kRingSlots.size()), 0,
                tile_grid::kOuter>
      from_ring_;  // W1^-1 S11, a column for each of kRingSlots
};

}  // namespace limitsurf
