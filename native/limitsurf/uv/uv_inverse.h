// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_cell_inverse.h"

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
/// A patch is quartered until the lattice has no point in its cells' control hulls, or they are
/// such as CellInverse can serve. Where the Jacobian determinant vanishes that never comes to be:
/// there quartering goes on to the tolerance, or if that takes more than kMostDeepCells cells, as
/// it does where a whole edge of a patch leads to one lattice point, a least-squares iteration
/// looks for one place in each. Patches whose image has no area, only length, take no values.
class LatticeInverse {
 public:
  LatticeInverse(const Lattice& lattice, const Point2& tolerance, FindSink& sink)
      : lattice_(lattice), tolerance_(tolerance), sink_(sink) {}

  void add(const UvCell& patch);
  /// The same for a small part of a patch whose image has an area: it may be too thin to tell.
  void addPart(const UvCell& part);
  /// Whether the image has no area, to the tolerance.
  bool isFlat(const UvCell& patch) const;

  const Lattice& lattice() const { return lattice_; }
  const Point2& tolerance() const { return tolerance_; }
  /// Lattice points within a box, or the tolerance of it.
  Lattice within(const Box2& box) const { return lattice_.within(box.grown(tolerance_)); }

 private:
  static constexpr int kQuarterings = 10;
  static constexpr int kMostQuarterings = 40;
  static constexpr int kMostDeepCells = 1024;
  /// Cells of so many tolerances are as good as points.
  static constexpr double kTiny = 16;
  /// Cells on which the border is so wide are too small for directions; of the cell's side.
  static constexpr double kWidestBorder = 1. / 8;

  void addCell(const UvCell& cell, int depth);
  /// Whether points lie beside a cell's image, seen along its longer diagonal: boxes around slanted
  /// images, thin ones above all, tell little.
  bool isBeside(const UvCell& cell, const Lattice& inside) const;
  void addRows(const UvCell& cell, const CellInverse& inverse, const Lattice& inside);
  void addPlace(const UvCell& cell, const CellInverse& inverse, const CellInverse::Place& place,
                int x, int y);
  void addNearest(const UvCell& cell, const Lattice& inside);

  const Lattice lattice_;
  const Point2 tolerance_;
  FindSink& sink_;
  int deep_cells_ = 0;  // of the present patch, quartered more than kQuarterings times
};

}  // namespace limitsurf
