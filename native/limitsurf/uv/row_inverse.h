// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// A cell as CellInverse has it, in plain numbers: first x, then y.
struct CellNumbers {
  double coefficients[2][16];  ///< of powers of s and t about the middle: [4 t + s]
  double m_s[2], m_t[2];       ///< the columns of the inverse of the mean Jacobian matrix
  double tolerance[2];
  double curvature, contraction;
  double reach;  ///< how far beyond the cell the place of a point within the tolerance may lie
};

/// Rows of lattice points, side by side, of which a cell is inverted. Each point starts from those
/// before it in its row.
struct InverseRows {
  static constexpr int kCount = 8;
  static constexpr int kBlock = 32;  ///< points of a row that are looked for at a time

  int count = 0;                           ///< the number of rows that are used
  double x0[kCount] = {}, y[kCount] = {};  ///< the first point of each row
  double length[kCount] = {};              ///< the numbers of points; 0 for rows without one
  /// The last place of each row, the step that led there, and the one before.
  double last[2][kCount] = {}, step[2][kCount] = {}, before[2][kCount] = {};

  // Of each point of the block: its place, in coordinates from -1/2 to 1/2 about the middle of the
  // cell, the Jacobian determinant, and whether the cell has the point (1 or 0; between them if
  // that is doubtful: then the place is one on a side near it).
  double s[kBlock][kCount], t[kBlock][kCount], determinant[kBlock][kCount], found[kBlock][kCount];
};

/// The inverse of a cell for points of several rows at once, compiled for one instruction set. A
/// point's results depend neither on the set nor on the other rows.
struct RowInverse {
  /// Finds the points `begin` to `end` of each row, at most kBlock, which come after those that
  /// were found last.
  void (*find)(const CellNumbers& cell, InverseRows& rows, int begin, int end);

  /// For the instruction set in use.
  static const RowInverse& get();
};

}  // namespace limitsurf
