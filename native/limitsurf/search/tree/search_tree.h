// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "limitsurf/first_made.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/search/rings/search_rings.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/search/tree/closer_boxes.h"
#include "limitsurf/search/tree/leaf_maker.h"
#include "limitsurf/search/tree/nest_store.h"
#include "limitsurf/search/tree/tree_part.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

class NormalCones;

/// The patches of a surface under a tree of boxes, and their common unit: `scale` times lengths of
/// the surface, so that the diagonal of the control mesh is about 1. Boxes are in that unit and
/// relative to `middle`, so that single precision can hold squares of their coordinates.
///
/// The top of the tree has regular patches as leaves, and nests: the parts of the tree below Ptex
/// faces with extraordinary vertices, which have many leaves each. A nest is made when a search
/// first reaches it, so that a few searches in each pose of a surface do not pay for all. Nodes of
/// the top over long and narrow faces have boxes of their own directions (CloserBoxes) besides.
struct SearchTree {
  SearchTree(const LimitSurface& limit_surface, int threads);
  ~SearchTree();

  const LimitSurface& surface;
  SurfacePatches patches;
  double scale;  ///< a power of two
  /// Where most of the vertices are, if only outliers make the mesh large. Boxes there keep their
  /// digits in single precision if the coordinates begin there.
  std::optional<Vector3> crowd;
  Vector3 middle;  ///< the crowd, or the middle of the mesh
  /// The error that a search may leave: a tenth of kSearchError.
  double tolerance;
  Vector3 inBoxes(const Vector3& point) const { return point - middle; }

  SearchRings rings;

  bool empty() const { return top_.nodes.empty(); }
  static constexpr std::int32_t kTop = -1;
  /// Where a walk begins.
  static constexpr NearestFirst::Entry kRoot{0, -std::numeric_limits<float>::infinity(), kTop};
  /// The part of the tree that a node or a leaf is in. A nest, which is a node without children in
  /// the top, becomes the root of its own part, which is made if nobody has asked for it before.
  const TreePart& part(NearestFirst::Entry& at) const {
    if (at.part == kTop) {
      if (at.place < first_nest_) {
        return top_;
      }
      at.part = at.place - first_nest_;
      at.place = 0;
    }
    return nest(at.part);
  }
  /// Has the memory of a node or a leaf brought into the processor's caches.
  void expect(const NearestFirst::Entry& at) const;

  const TreePart& top() const { return top_; }
  /// Of a node of the top, if it has them: WideTree::Node::closer.
  const CloserBoxes& closerBoxes(const WideTree::Node& node) const {
    return closer_boxes_[static_cast<std::size_t>(node.closer)];
  }
  std::int32_t nestCount() const { return static_cast<std::int32_t>(nest_tiles_.size()); }
  /// To be called before so many searches. When there have been as many as there are nests, those
  /// that are left are made, one after the other: searches that reach them in no particular order
  /// would take longer. Must not be called from within a parallel loop.
  void prepare(std::size_t searches, int threads) const;
  void makeAllNests(int threads) const;
  /// The number of nests that have been made.
  std::int32_t nestsMade() const;
  const TreePart& nest(std::int32_t i) const {
    const TreePart* const made = nests_->made(static_cast<std::size_t>(i));
    return made ? *made : makeNest(i);
  }

  /// Cones around normals, made when they are first asked for. Must not be called from within a
  /// parallel loop.
  const NormalCones& normalCones(int threads) const;

 private:
  /// The memory for kept patches of all parts.
  static constexpr std::size_t kPatchBytes = std::size_t{64} << 20;

  /// The tiles of a Ptex face.
  struct Tiles {
    int first, count;
  };
  struct Pieces;

  /// Appends the leaves of a face's tiles, or the face as a nest.
  void addFace(const Tiles& tiles, Pieces& out) const;
  std::vector<SurfacePiece> piecesOf(const Tiles& tiles) const;
  const TreePart& makeNest(std::int32_t i) const;

  LeafMaker maker_;
  LargePageVector<WideTree::Node> top_nodes_;
  LargePageVector<SearchLeaf> top_leaves_;
  LargePageVector<BezierPatch> top_patches_;
  std::vector<CloserBoxes> closer_boxes_;
  TreePart top_;
  std::int32_t first_nest_ = 0;  ///< its number as a child in the top: nests come after all nodes
  std::vector<Tiles> nest_tiles_;
  std::unique_ptr<NestStore> nests_;
  mutable std::atomic<std::size_t> searches_{0};
  FirstMade<NormalCones> cones_;
};

/// The patches of leaves: kept by the tree, or else in a cache, since neighbouring searches need
/// the same patches. A cache belongs to one thread.
class PatchCache {
 public:
  explicit PatchCache(const SearchTree& data) : data_(data) {}

  /// The patch of a leaf, which is in a part of the tree.
  const BezierPatch& patch(const TreePart& part, const NearestFirst::Entry& at) {
    const auto leaf = static_cast<std::size_t>(WideTree::leaf(at.place));
    if (!part.kept.empty()) {
      return part.kept[leaf];
    }
    if (!patches_) {
      patches_.reset(new BezierPatch[kSize]);
    }
    // Neighbouring nests have neighbouring numbers, and need different slots.
    const std::size_t slot =
        (static_cast<std::size_t>(at.part - SearchTree::kTop) * kLeavesPerNest + leaf) % kSize;
    const SearchLeaf* const of = &part.leaves[leaf];
    if (leaves_[slot] != of) {
      patches_[slot] = data_.patches.patch(of->piece);
      leaves_[slot] = of;
    }
    return patches_[slot];
  }

  /// Has the memory of a patch brought into the processor's caches, if the tree keeps it.
  static void expect(const TreePart& part, std::int32_t leaf) {
    if (!part.kept.empty()) {
      prefetch(part.kept[static_cast<std::size_t>(leaf)]);
    }
  }

 private:
  static constexpr std::size_t kSize = 256;
  static constexpr std::size_t kLeavesPerNest = 10;  // as most have
  const SearchTree& data_;
  std::unique_ptr<BezierPatch[]> patches_;
  const SearchLeaf* leaves_[kSize] = {};
};

}  // namespace limitsurf
