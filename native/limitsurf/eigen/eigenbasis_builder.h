// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "limitsurf/eigen/circle.h"
#include "limitsurf/eigen/curve_mode.h"
#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/spoke_mode.h"

namespace limitsurf {

/// Fills an Eigenbasis, in long double.
class Eigenbasis::Builder {
 public:
  explicit Builder(Eigenbasis& basis) : basis_(basis), ring_(basis.ring_) {}
  void build();

 private:
  using Real = long double;
  using Outer = OuterModes<Real>;
  using Cells = Outer::Cells;
  struct Wide {  // a Table before rounding
    Outer::Vector outer;
    Cells grid;
    Outer::Vector rest;
  };

  void buildCircle();
  void buildSpokes();
  void buildRadial();
  void buildCurves();
  void buildOuterTables(Sides sides);

  const Outer& outer(Sides sides);
  /// A vector with ring part `ring_cells` that a step takes to lambda times itself plus `feeds`
  /// times the vector `fed`.
  Wide continued(Sides sides, Real lambda, const Cells& ring_cells, Real feeds = 0,
                 const Wide* fed = nullptr);
  Cells spokeCells(Real angle_numerator, Real edge, Real face, bool sine) const;
  Wide spokeTable(Sides sides, int m, bool plus, bool sine);
  Wide spokeOnFace(int m, bool plus, int face);
  Cells ringCells(const std::vector<Real>& ring, int face) const;
  static Table rounded(const Wide& wide);

  Eigenbasis& basis_;
  const Ring ring_;
  std::map<Sides, Outer> outer_;
};

}  // namespace limitsurf
