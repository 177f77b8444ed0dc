// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/bake/uv_cell_inverse.h"

namespace limitsurf {

/// The directions in the plane from `first` counter-clockwise to `last`.
struct Wedge {
  Point2 first, last;
};

/// A place at which a patch takes the value of a lattice point.
struct Find {
  int x, y;
  double s, t;   ///< of the patch
  bool flipped;  ///< the Jacobian determinant is negative
  /// On a border of the cell it was found in, to the tolerance: another cell may have the same
  /// place. The cell's image around it consists of these wedges, of none if that is not known.
  bool on_border = false;
  int wedge_count = 0;
  Wedge wedges[2];
};

/// Is told of finds.
class FindSink {
 public:
  virtual void add(const Find& find) = 0;

 protected:
  ~FindSink() = default;
};

/// All places at which patches take the values of lattice points.
///
/// A patch is quartered until the lattice has no point in the box around the control points, or the
/// cell is one that CellInverse can serve. Where the Jacobian determinant vanishes that never comes
/// to be; after kMostQuarterings a least-squares iteration looks for one place in what is left, so
/// that two places less than 2^-kMostQuarterings of a patch apart may count as one. Patches whose
/// image has no area, only length, take no values.
class LatticeInverse {
 public:
  LatticeInverse(const Lattice& lattice, const Point2& tolerance, FindSink& sink)
      : lattice_(lattice), tolerance_(tolerance), sink_(sink) {}

  void add(const UvCell& patch) { addCell(patch, 0); }

  const Lattice& lattice() const { return lattice_; }
  const Point2& tolerance() const { return tolerance_; }
  /// Lattice points within a box, or the tolerance of it.
  Lattice within(const Box2& box) const { return lattice_.within(box.grown(tolerance_)); }

 private:
  static constexpr int kMostQuarterings = 14;
  /// Tolerances; images that are shorter are done with as points.
  static constexpr double kNoLength = 1000;

  void addCell(const UvCell& cell, int depth);
  void addRows(const UvCell& cell, const CellInverse& inverse, const Lattice& inside);
  void addPlace(const UvCell& cell, const CellInverse& inverse, const CellInverse::Place& place,
                int x, int y);
  void addNearest(const UvCell& cell, const Lattice& inside);

  const Lattice lattice_;
  const Point2 tolerance_;
  FindSink& sink_;
};

}  // namespace limitsurf
