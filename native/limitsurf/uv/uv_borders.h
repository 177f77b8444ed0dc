// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/interruption_point.h"
#include "limitsurf/uv/uv_patches.h"

namespace limitsurf {

/// A cubic piece of a border of the map, in the coordinates of a lattice.
struct BorderCurve {
  Point2 points[4];   ///< Bezier points
  FaceRectangle on;   ///< the rectangle of the patch of which the curve is a side
  Point2 begin, end;  ///< (s, t) of the ends on that patch
  bool flipped;

  Location at(double part) const {
    const Point2 st = begin + part * (end - begin);
    return on.at(st[0], st[1]);
  }
};

/// The borders of what a map covers: the sides of its pieces beyond which there is no other piece,
/// and points of the curves along which the map folds back. A side between two pieces may be among
/// them if the pieces do not have the same corners, but no border is missing.
class UvBorders {
 public:
  /// Refers to `map`. Cost: O(pieces log pieces).
  UvBorders(const UvPatches& map, int threads);

  /// Appends the borders that are no farther from a box than `reach`. Where a side runs into an
  /// extraordinary vertex, its last piece, of the length `detail` at most, is straight.
  void appendCurves(const PlaneFrame& frame, const Box2& box, double reach, double detail,
                    std::vector<BorderCurve>& out) const;

 private:
  /// The sides of a piece that are borders, as bits: side i leads from corner i to the next.
  struct Sides {
    int piece;
    unsigned sides;
    bool flipped;
    bool folds;
  };

  void appendSide(const BezierPatch& patch, int side, bool flipped, const PlaneFrame& frame,
                  std::vector<BorderCurve>& out) const;
  void appendCoreSides(const Sides& of, const PlaneFrame& frame, const Box2& around, double detail,
                       InterruptionStride& stride, std::vector<BorderCurve>& out) const;

  /// Appends the rests of the two sides at a core's vertex, after its last split.
  void appendLastSides(const Sides& of, const PlaneFrame& frame, const SurfacePiece& core,
                       const SurfacePatches::SplitCore& split, std::vector<BorderCurve>& out) const;

  const UvPatches& map_;
  std::vector<Sides> sides_;
};

}  // namespace limitsurf
