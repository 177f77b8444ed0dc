// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>

#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/eigen/outer_modes.h"

namespace limitsurf {

/// Continues modes from the ring to the whole grid of a face, in long double.
class ModeContinuation {
 public:
  using Real = long double;
  using Outer = OuterModes<Real>;
  using Cells = Outer::Cells;

  struct Wide {  ///< a ModeTable before rounding
    Outer::Vector outer;
    Cells grid;
    Outer::Vector rest;  ///< what the mode feeds into the outer modes
  };

  const Outer& outer(Sides sides);

  /// A vector with ring part `ring_cells` that a step takes to lambda times itself plus `feeds`
  /// times the vector `fed`.
  Wide continued(Sides sides, Real lambda, const Cells& ring_cells, Real feeds = 0,
                 const Wide* fed = nullptr);

  /// The same, where lambda is so close to the eigenvalue `met` of S12 that the mode had better
  /// feed its outer modes.
  Wide continuedBeside(Sides sides, Real lambda, Real met, const Cells& ring_cells);

  /// Two vectors a and b that a step takes to mean a + forth b and to mean b + back a.
  std::array<Wide, 2> continuedPair(Sides sides, Real mean, Real forth, Real back,
                                    const std::array<Cells, 2>& ring_cells);

  /// The function a x + b y, which a step halves: exactly, lest second derivatives see anything.
  Wide linear(Sides sides, Real a, Real b);

  static ModeTable rounded(const Wide& wide);

 private:
  /// One step of the grid whose ring part becomes `next_ring`.
  void stepGrid(const Outer& outer, const Cells& ring_cells, const Cells& next_ring, Wide& wide);

  std::map<Sides, Outer> outer_;
};

}  // namespace limitsurf
