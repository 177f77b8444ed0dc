// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/displace/subdivided_faces.h"

namespace limitsurf {

/// The faces that one face becomes when it is subdivided: a grid of side x side faces on each of
/// its Ptex faces (parts). The face (i, j) of a grid begins at (u, v) = (i, j) / side, and its
/// corners stand in the order of (u, v) in every program.
class FaceGrid {
 public:
  /// `levels` must be at least 1.
  FaceGrid(int corners, int levels)
      : parts_(corners == 4 ? 1 : corners), side_log2_(corners == 4 ? levels : levels - 1) {}

  int parts() const { return parts_; }
  int sideLog2() const { return side_log2_; }
  int side() const { return 1 << side_log2_; }
  int count() const { return parts_ * side() * side(); }

  /// The number of a face of the grid in a program's order, 0 to count() - 1.
  int index(FaceOrder order, int part, int i, int j) const;

 private:
  int recursiveIndex(int part, int i, int j) const;
  int quadIndex(int i, int j) const;
  int splitIndex(int part, int i, int j) const;

  int parts_;
  int side_log2_;
};

}  // namespace limitsurf
