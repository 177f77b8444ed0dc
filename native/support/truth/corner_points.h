// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/cages/cage.h"
#include "support/truth/sharpness.h"

namespace limitsurf::test {

/// What is at a corner of a Ptex face when all finite sharpness has decayed.
struct CornerPoint {
  Rule rule = Rule::smooth;
  int faces = 4;       ///< quads after one subdivision: around it, or of its sector, which reaches
                       ///< from one infinitely sharp edge (or boundary) to another
  bool closed = true;  ///< whether these are all around it
  bool loop = false;   ///< whether they begin and end at the same edge
  int vertex = -1;     ///< of the cage; -1 at face centres and edge midpoints
  bool sharp_next = false, sharp_previous = false;  ///< the Ptex face's sides from and to it

  /// Whether the face is a B-spline patch there.
  bool regular() const;
  /// Position apart, the contract of what there is (limit_surface.h).
  bool hasNormal() const;
  /// Along the side to the next corner or from the previous one.
  bool hasCurve(bool next) const;
  /// Whether both first derivatives vanish.
  bool isFlat() const { return rule == Rule::smooth && faces <= 3; }
};

/// Corner points by Ptex face and corner (0 to 3, in the order (0,0), (1,0), (1,1), (0,1)).
class CornerPoints {
 public:
  explicit CornerPoints(const Cage& cage);
  const CornerPoint& at(int face, int corner) const { return corners_[4 * face + corner]; }
  /// The corner at which the location is exactly, or null.
  const CornerPoint* at(const Location& location) const;
  /// Whether the location is within 2^-20 of a smooth corner of one face, where du and dv become
  /// antiparallel and kNormalError is not promised.
  bool insideSmoothCorner(const Location& location) const;

 private:
  std::vector<CornerPoint> corners_;
};

/// The number of the corner at which the location is exactly, or -1.
int cornerAt(const Location& location);

/// Whether the location lies on a side of its face, but not at a corner, and the side is a boundary
/// or an infinitely sharp edge. Not valid for the bilinear scheme.
bool isOnBorder(const CornerPoints& corners, const Location& at);

}  // namespace limitsurf::test
