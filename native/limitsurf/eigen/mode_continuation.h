// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>

#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/eigen/outer_modes.h"

namespace limitsurf {

/// Continues modes from the ring to the whole grid of a face, in long double: the columns of U1 of
/// Lacewell & Burley 2007, section 3.1, and the grid after a step.
class ModeContinuation {
 public:
  using Real = long double;
  using Outer = OuterModes<Real>;
  using SlotValues = Outer::SlotValues;

  struct Wide {  ///< a ModeTable before rounding
    Outer::Vector outer;
    SlotValues grid;
    Outer::Vector rest;  ///< what a step feeds from the mode into the outer modes
  };

  const Outer& outer(Sides sides);

  /// The vector with the ring part `ring_values` that a step takes to lambda times itself plus
  /// `feeds` times the vector `fed`.
  Wide continued(Sides sides, Real lambda, const SlotValues& ring_values, Real feeds = 0,
                 const Wide* fed = nullptr);

  /// The same, where lambda is so close to the eigenvalue `met` of S12 that solving for the outer
  /// part would lose digits: the mode feeds the outer modes to `met` instead.
  Wide continuedBeside(Sides sides, Real lambda, Real met, const SlotValues& ring_values);

  /// The two vectors a and b that a step takes to mean a + forth b and to mean b + back a.
  std::array<Wide, 2> continuedPair(Sides sides, Real mean, Real forth, Real back,
                                    const std::array<SlotValues, 2>& ring_values);

  /// The function a x + b y, which a step halves. Its values are exact, so that its second
  /// derivatives are exactly 0.
  Wide linear(Sides sides, Real a, Real b);

  static ModeTable rounded(const Wide& wide);

 private:
  /// Fills wide.grid with the grid after one step, whose ring part is `next_ring`.
  void stepGrid(const Outer& outer, const SlotValues& ring_values, const SlotValues& next_ring,
                Wide& wide);

  std::map<Sides, Outer> outer_;
};

}  // namespace limitsurf
