// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/displace/subdivided_faces.h"

namespace limitsurf {

/// The faces that one face becomes when it is subdivided: side x side cells of each of its Ptex
/// faces (parts), the cell (i, j) at (i, j) / side, and its corners in the order of (u, v)
/// whichever program made it.
class FaceCells {
 public:
  /// `levels` is 1 at least.
  FaceCells(int corners, int levels)
      : parts_(corners == 4 ? 1 : corners), side_log2_(corners == 4 ? levels : levels - 1) {}

  int parts() const { return parts_; }
  int sideLog2() const { return side_log2_; }
  int side() const { return 1 << side_log2_; }
  int count() const { return parts_ * side() * side(); }

  /// Among the face's faces, 0 to count() - 1.
  int index(FaceOrder order, int part, int i, int j) const;

 private:
  int recursiveIndex(int part, int i, int j) const;
  int quadIndex(int i, int j) const;
  int splitIndex(int part, int i, int j) const;

  int parts_;
  int side_log2_;
};

}  // namespace limitsurf
