// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/uv/uv_patches.h"

namespace limitsurf {

/// A cubic piece of a border of the map, in a lattice's coordinates.
struct BorderCurve {
  Point2 points[4];   ///< Bezier
  FaceRectangle on;   ///< of the patch that it is a side of
  Point2 begin, end;  ///< there: (s, t)
  bool flipped;

  Location at(double part) const {
    const Point2 st = begin + part * (end - begin);
    return on.at(st[0], st[1]);
  }
};

/// Around all that a map covers: the sides of its pieces that have no other piece beyond them, and
/// points along curves on which it folds. Sides between two pieces may be among them where those
/// have not the same corners, never the other way round.
class UvBorders {
 public:
  /// Refers to `map`. Cost: O(pieces log pieces).
  UvBorders(const UvPatches& map, int threads);

  /// Those no farther from a box than `reach`, appended to `out`. Where a side runs into an
  /// extraordinary vertex, a straight piece of the length `detail` ends the matter.
  void appendCurves(const PlaneFrame& frame, const Box2& box, double reach, double detail,
                    std::vector<BorderCurve>& out) const;

 private:
  /// Sides of a piece that are borders, as bits: side i leads from corner i to the next.
  struct Sides {
    int piece;
    unsigned sides;
    bool flipped;
    bool folds;
  };

  void appendSide(const BezierPatch& patch, int side, bool flipped, const PlaneFrame& frame,
                  std::vector<BorderCurve>& out) const;
  void appendCoreSides(const Sides& of, const PlaneFrame& frame, const Box2& around, double detail,
                       std::vector<BorderCurve>& out) const;

  const UvPatches& map_;
  std::vector<Sides> sides_;
};

}  // namespace limitsurf
