// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/rings/search_rings.h"
#include "limitsurf/search/tree/tree_part.h"

namespace limitsurf {

/// Makes the leaves of a search tree, and boxes around them relative to `middle`.
class LeafMaker {
 public:
  /// Refers to the patches and the rings.
  LeafMaker(const SurfacePatches& patches, const SearchRings& rings, const Vector3& middle)
      : patches_(patches), rings_(rings), middle_(middle) {}

  struct Leaf {
    SearchLeaf leaf;
    BoxF box;
  };

  Leaf ofPatch(const SurfacePiece& piece, const BezierPatch& patch) const;
  /// That of a core of a few faces. `split` may hold the split of which the core is the rest.
  Leaf ofCore(const SurfacePiece& core, SurfacePatches::SplitCore& split) const;
  /// The leaf of all cores around a vertex with many faces.
  Leaf ofRing(int ring) const;

  /// Whether all cores around the core's vertex are one leaf.
  bool isOfRing(const SurfacePiece& core) const { return rings_.isLarge(patches_.ringOf(core)); }
  /// The number of steps that a core is split before searches, so that its box fits closely.
  int stepsBefore(const SurfacePiece& core) const;

  struct BoxedArea {
    Box box;
    double area = 0;  ///< of what is in the box, roughly
  };
  /// A box around the leaves of some pieces of a face, but for those leaves that are of whole
  /// rings. It is empty if there are no others.
  BoxedArea boxAround(const std::vector<SurfacePiece>& pieces) const;
  /// The same as an oriented box. There must be such leaves.
  LeafBox orientedBoxAround(const std::vector<SurfacePiece>& pieces) const;

 private:
  /// Calls onPatch(patch) and onRest(points) for what contains these leaves.
  template <typename OnPatch, typename OnRest>
  void visit(const std::vector<SurfacePiece>& pieces, const OnPatch& onPatch,
             const OnRest& onRest) const;

  const SurfacePatches& patches_;
  const SearchRings& rings_;
  const Vector3 middle_;
};

}  // namespace limitsurf
