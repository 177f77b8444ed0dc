// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/circle.h"
#include "limitsurf/eigen/curve_mode.h"
#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/mode_continuation.h"
#include "limitsurf/eigen/spoke_mode.h"

namespace limitsurf {

/// Computes an Eigenbasis, in double-doubles.
class Eigenbasis::Builder {
 public:
  explicit Builder(Eigenbasis& basis) : basis_(basis), ring_(basis.ring_) {}
  void build();

 private:
  using Real = DoubleDouble;
  using SlotValues = ModeContinuation::SlotValues;
  using Wide = ModeContinuation::Wide;

  void buildCircle();
  void buildSpokes();
  void buildSpoke(int m);
  void buildRadial();
  void buildBend();
  void buildCurves();
  void buildDart();
  void buildOuterTables(Sides sides);

  /// The spoke modes number m.
  SpokeMode<Real> spokeMode(int m) const {
    return SpokeMode<Real>::at(ring_.closed() ? 2 * std::int64_t{m} : m, ring_.faces);
  }
  /// sin and cos of the angle 2 pi i / period, which may be negative.
  const SineCosine<Real>& circleAt(std::int64_t i) const {
    const std::int64_t rest = i % basis_.period_;
    return circle_[static_cast<std::size_t>(rest < 0 ? rest + basis_.period_ : rest)];
  }
  SlotValues spokeValues(int m, const SpokeMode<Real>::Vector& vector, bool sine) const;
  Wide spokeTable(Sides sides, int m, const SpokeMode<Real>& mode, bool plus, bool sine);
  Wide spokeOnFace(int m, const SpokeMode<Real>& mode, bool plus, int face);
  SlotValues ringValues(const std::vector<Real>& ring, int face) const;

  Eigenbasis& basis_;
  const Ring ring_;
  std::vector<SineCosine<Real>> circle_;
};

}  // namespace limitsurf
