// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/search/closest_on_patch.h"
#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {

/// A lower bound of the squared distance of a box, less the square of the range. `in_boxes` is the
/// searching point in the coordinates of boxes.
template <typename Real>
double squaredDistanceTo(const OrientedBox<Real>& box, const SearchPoint& from,
                         const Vector3& in_boxes) {
  return from.isFar() ? box.squaredDistanceLess(from.away) : box.squaredDistance(in_boxes);
}

/// The part of a search for a closest point that looks at cores, the surface next to extraordinary
/// vertices: after all patches have been searched. The vertex of a core is a first guess, and if it
/// stayed the best one while its own core is split, no bound of the rest, which always contains the
/// vertex, would end that.
class ClosestOnCores {
 public:
  /// Refers to both.
  ClosestOnCores(const SearchTree& data, ClosestSoFar& best) : data_(data), best_(best) {}

  /// Begins another search, from best.from.
  void begin(const Facing* facing, const Vector3& point_in_boxes);
  /// Leaves a core for later; its vertex is offered at once. `squared` is a lower bound of its
  /// squared distance.
  void putOff(const SurfacePiece& core, double squared);
  /// Searches the cores that were put off, always the nearest one first.
  void visit();
  /// The number of cores split so far, in all searches.
  std::int64_t splitCount() const { return split_count_; }

 private:
  /// A core that was put off, or what is left of one.
  struct OpenCore {
    double squared;  ///< a lower bound of its squared distance
    std::size_t split;
    SurfacePiece core;

    bool operator<(const OpenCore& other) const {  // the nearest one becomes the top of a heap
      return squared != other.squared ? squared > other.squared : split > other.split;
    }
  };
  struct SeenFromVertex;

  /// Whether the rest of a core may be taken for its vertex: it is smaller than the tolerance, or
  /// smaller than what a Location can tell, if normals matter.
  bool isSmall(const SurfacePiece& core) const;
  bool hasTooFewDigits(const SurfacePiece& core) const;
  /// Splits a core and searches its patches.
  void visitParts(const SurfacePiece& core, SurfacePatches::SplitCore& split);
  /// Searches the rest of a core that may be taken for its vertex.
  void visitLast(const SurfacePiece& core, SurfacePatches::SplitCore& split);
  /// Offers the vertex in place of the rest of a core.
  void offerVertex(const SurfacePiece& core);

  /// With a condition on normals: whether what is left of a core is so small, as seen from the
  /// point, that the surface around the vertex tells that there is no minimum in it.
  bool hasNoFoot(int ring, const SurfacePiece& core);
  /// mayHaveMinimumNear(), asked once for the cores of a ring that follow each other.
  bool mayHaveMinimum(int ring, const Vector3& way);

  SeenFromVertex seenFrom(int ring, const SurfacePiece& core) const;
  /// Whether the point lies on the axis of a ring with the symmetry of a regular polygon, and the
  /// core is another than the first one, to which it is as near.
  bool isLikeTheFirst(const SurfacePiece& core) const;
  /// Whether no point between the cores of a level and those of the next can be closer.
  bool cannotMatter(const RingLevel& level, const SeenFromVertex& seen) const;
  /// Searches all cores around a vertex, level by level.
  void visitRing(int ring, SurfacePiece core);
  /// Searches the patches between the cores of a level and those of the next, nearer ones first.
  void visitSectors(int ring, int level, const SeenFromVertex& seen);

  const SearchTree& data_;
  ClosestSoFar& best_;
  const Facing* facing_ = nullptr;
  Vector3 point_in_boxes_ = Vector3::Zero();
  std::int64_t split_count_ = 0;
  std::vector<OpenCore> open_;
  std::vector<std::unique_ptr<SurfacePatches::SplitCore>> splits_;  // of open cores
  SurfacePatches::SplitCore ring_split_;
  /// The ring that mayHaveMinimum() was asked about last, and its answer.
  int asked_ring_ = -1;
  bool may_have_minimum_ = true;
};

}  // namespace limitsurf
