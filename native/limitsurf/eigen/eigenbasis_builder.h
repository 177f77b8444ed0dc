// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/circle.h"
#include "limitsurf/eigen/curve_mode.h"
#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/mode_continuation.h"
#include "limitsurf/eigen/spoke_mode.h"

namespace limitsurf {

/// Computes an Eigenbasis, in long double.
class Eigenbasis::Builder {
 public:
  explicit Builder(Eigenbasis& basis) : basis_(basis), ring_(basis.ring_) {}
  void build();

 private:
  using Real = long double;
  using SlotValues = ModeContinuation::SlotValues;
  using Wide = ModeContinuation::Wide;

  void buildCircle();
  void buildSpokes();
  void buildRadial();
  void buildCurves();
  void buildDart();
  void buildOuterTables(Sides sides);

  SlotValues spokeValues(int m, const SpokeMode<Real>::Vector& vector, bool sine) const;
  Wide spokeTable(Sides sides, int m, bool plus, bool sine);
  Wide spokeOnFace(int m, bool plus, int face);
  SlotValues ringValues(const std::vector<Real>& ring, int face) const;

  Eigenbasis& basis_;
  const Ring ring_;
  ModeContinuation continuation_;
};

}  // namespace limitsurf
