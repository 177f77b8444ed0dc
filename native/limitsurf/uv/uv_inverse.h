// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

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
  /// Whether a find in a cell of the patch would be used if no wedges are known around it.
  virtual bool wants(int x, int y, const UvCell& cell) const = 0;

 protected:
  ~FindSink() = default;
};

/// Finds all places at which patches take the values of lattice points.
///
/// A patch is divided until the control hull of a cell contains no lattice point, or CellInverse
/// can invert the cell. Neither happens where the Jacobian determinant vanishes: there division
/// ends at the size of the tolerance or after kMostDeepCells cells, and a least-squares iteration
/// searches for one place in each remaining cell. It also decides about points that are so close to
/// a side of a cell that Newton's iteration cannot. Patches whose image has no area take no values.
///
/// The cost of a patch is bounded, whatever its points are: for n lattice points in its box, at
/// most kMostCells + n cells are divided, kMostSearches + 2n searches are made, and remaining
/// cells are compared with points kMostTrials + 64n times. A patch that needs more is degenerate
/// nearly everywhere, or tolerances are larger than the distances of lattice points; places on it
/// may be missed.
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

  static constexpr std::int64_t kMostCells = 1 << 14, kMostSearches = 1 << 14,
                                kMostTrials = 1 << 22;
  /// What has been done so far, for all patches.
  struct Work {
    std::int64_t divided = 0;   ///< cells
    std::int64_t searches = 0;  ///< by least squares
    std::int64_t trials = 0;    ///< pairs of a remaining cell and a point
  };
  const Work& work() const { return work_; }

 private:
  /// Cells are divided if they are larger than this part of their patch; of smaller ones, at most
  /// kMostDeepCells of a patch are, down to sides of this length. Chosen, not derived.
  static constexpr double kFreeArea = 0x1p-20;
  static constexpr int kMostDeepCells = 1024;
  static constexpr double kLeastSide = 0x1p-40;
  /// A cell whose image is at most this many tolerances large is not divided any more.
  static constexpr double kTiny = 16;
  /// If the border of a cell (CellInverse::borderWidth()) is wider than this part of its side, the
  /// cell is too small for directions.
  static constexpr double kWidestBorder = 1. / 8;

  /// Begins with a patch or a part of one.
  void begin(const Lattice& inside);
  void addCell(const UvCell& cell);
  /// Whether a cell that cannot be inverted is searched instead of divided.
  bool isLast(const UvCell& cell, const Box2& box);
  /// Inverts a cell some rows at a time, each point starting from its neighbours in the row.
  void addRows(const UvCell& cell, const CellInverse& inverse, const Lattice& inside);
  /// Adds a place in the cell, in coordinates from -1/2 to 1/2 about the middle.
  void addPlace(const UvCell& cell, const CellInverse& inverse, const Point2& place,
                double determinant, int x, int y);
  /// Adds the nearest place in the cell if the cell has the point, up to the tolerance: the
  /// iteration has ended beside a side, at `start`, and does not tell.
  void addDoubtful(const UvCell& cell, const CellInverse& inverse, const Point2& start, int x,
                   int y);
  /// Searches by least squares for the places nearest to the points.
  void addNearest(const UvCell& cell, const Lattice& inside);

  const Lattice lattice_;
  const Point2 tolerance_;
  const RowInverse& kernel_ = RowInverse::get();
  FindSink& sink_;
  Work work_;
  Work limit_;          // what work_ may be after the present patch
  int deep_cells_ = 0;  // cells of the present patch that are smaller than kFreeArea
};

}  // namespace limitsurf
