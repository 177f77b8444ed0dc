// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_cell_inverse.h"

namespace limitsurf {

/// The directions of the plane from `first` counter-clockwise to `last`.
struct Wedge {
  Point2 first, last;
};

/// A find: a place at which a patch takes the value of a lattice point.
struct Find {
  int x, y;
  double s, t;   ///< parameters of the patch
  bool flipped;  ///< the Jacobian determinant is negative
  /// The place is on a border of its cell, up to the tolerance, so that another cell may have the
  /// same place. Around it the image of the cell consists of these wedges; of none if that is
  /// unknown.
  bool on_border = false;
  int wedge_count = 0;
  Wedge wedges[2];
};

/// A receiver of finds.
class FindSink {
 public:
  virtual void add(const Find& find) = 0;

 protected:
  ~FindSink() = default;
};

/// Finds all places at which patches take the values of lattice points.
///
/// A patch is quartered until the control hull of a cell contains no lattice point, or CellInverse
/// can invert the cell. Neither happens where the Jacobian determinant vanishes: there quartering
/// ends at the size of the tolerance or after kMostDeepCells cells (a whole edge of a patch that is
/// mapped to one lattice point takes more), and a least-squares iteration searches for one place in
/// each remaining cell. Patches whose image has no area take no values.
class LatticeInverse {
 public:
  LatticeInverse(const Lattice& lattice, const Point2& tolerance, FindSink& sink)
      : lattice_(lattice), tolerance_(tolerance), sink_(sink) {}

  void add(const UvCell& patch);
  /// The same for a small part of a patch whose image has an area, though that of the part may be
  /// indistinguishable from none.
  void addPart(const UvCell& part);
  /// Whether the image has no area, up to the tolerance.
  bool isFlat(const UvCell& patch) const;

  const Lattice& lattice() const { return lattice_; }
  const Point2& tolerance() const { return tolerance_; }
  /// The lattice points within the tolerance of a box.
  Lattice within(const Box2& box) const { return lattice_.within(box.grown(tolerance_)); }

 private:
  /// Every patch may be quartered kQuarterings times; beyond, at most kMostDeepCells cells of a
  /// patch are, down to kMostQuarterings times. Chosen, not derived.
  static constexpr int kQuarterings = 10;
  static constexpr int kMostQuarterings = 40;
  static constexpr int kMostDeepCells = 1024;
  /// A cell whose image is at most this many tolerances large is not quartered any more.
  static constexpr double kTiny = 16;
  /// If the border of a cell (CellInverse::borderWidth()) is wider than this part of its side, the
  /// cell is too small for directions.
  static constexpr double kWidestBorder = 1. / 8;

  void addCell(const UvCell& cell, int depth);
  /// Whether all points lie beside a cell's image, as seen along its longer diagonal. An
  /// axis-aligned box around a slanted, thin image would contain many points that the image does
  /// not.
  bool isBeside(const UvCell& cell, const Lattice& inside) const;
  /// Inverts a cell row by row, each point starting from its neighbours.
  void addRows(const UvCell& cell, const CellInverse& inverse, const Lattice& inside);
  void addPlace(const UvCell& cell, const CellInverse& inverse, const CellInverse::Place& place,
                int x, int y);
  /// Searches by least squares for the places nearest to the points.
  void addNearest(const UvCell& cell, const Lattice& inside);

  const Lattice lattice_;
  const Point2 tolerance_;
  FindSink& sink_;
  int deep_cells_ = 0;  // cells of the present patch quartered more than kQuarterings times
};

}  // namespace limitsurf
