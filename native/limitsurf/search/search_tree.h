// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "limitsurf/first_made.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/search/foot_bound.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/rings/search_rings.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/search/wide_tree.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A leaf of the search tree: a bicubic patch, or a core, which searches split when they reach it.
/// All cores around a vertex with many faces are one leaf, at the place of the first of them.
struct SearchLeaf {
  LeafBox box;
  SurfacePiece piece;
  FootBound foot_bound;  ///< of a patch
};

class NormalCones;

/// The patches of a surface under a tree of boxes, and their common unit: `scale` times lengths of
/// the surface, so that the diagonal of the control mesh is about 1. Boxes are in that unit and
/// relative to `middle`, so that single precision can hold squares of their coordinates.
struct SearchTree {
  SearchTree(const LimitSurface& limit_surface, int threads);
  ~SearchTree();

  const LimitSurface& surface;
  SurfacePatches patches;
  double scale;  ///< a power of two
  Vector3 middle;
  /// The error that a search may leave: a tenth of kSearchError.
  double tolerance;
  Vector3 inBoxes(const Vector3& point) const { return point - middle; }

  SearchRings rings;
  LargePageVector<SearchLeaf> leaves;  ///< in the order of the tree
  std::unique_ptr<WideTree> tree;
  /// The patches of the leaves, or none if they would need more than kPatchBytes together; those of
  /// cores are not set.
  LargePageVector<BezierPatch> kept;
  /// Cones around normals, made when they are first asked for. Must not be called from within a
  /// parallel loop.
  const NormalCones& normalCones(int threads) const;

 private:
  static constexpr std::size_t kPatchBytes = std::size_t{64} << 20;

  FirstMade<NormalCones> cones_;

  /// Appends the pieces of a tile and boxes around them. Cores are split so far that their boxes
  /// fit closely.
  void addLeaves(int tile, std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const;
  /// The number of steps that a core is split before searches.
  int stepsBefore(const SurfacePiece& core) const;
  /// Appends the cores around a vertex as one leaf.
  void addRing(int ring, std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const;
  void addCore(const SurfacePiece& core, SurfacePatches::SplitCore& split,
               std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const;
};

/// The patches of leaves: kept by the tree, or else in a cache, since neighbouring searches need
/// the same patches. A cache belongs to one thread.
class PatchCache {
 public:
  explicit PatchCache(const SearchTree& data) : data_(data) {
    if (data.kept.empty()) {
      patches_.reset(new BezierPatch[kSize]);
      std::fill(leaves_, leaves_ + kSize, -1);
    }
  }

  const BezierPatch& patch(std::int32_t leaf) {
    if (!data_.kept.empty()) {
      return data_.kept[static_cast<std::size_t>(leaf)];
    }
    const std::size_t slot = static_cast<std::uint32_t>(leaf) % kSize;
    if (leaves_[slot] != leaf) {
      patches_[slot] = data_.patches.patch(data_.leaves[leaf].piece);
      leaves_[slot] = leaf;
    }
    return patches_[slot];
  }

  /// Has the memory of a patch brought into the processor's caches, if the tree keeps it.
  void expect(std::int32_t leaf) const {
    if (!data_.kept.empty()) {
      prefetch(data_.kept[static_cast<std::size_t>(leaf)]);
    }
  }

 private:
  static constexpr std::size_t kSize = 256;
  const SearchTree& data_;
  std::unique_ptr<BezierPatch[]> patches_;
  std::int32_t leaves_[kSize];
};

}  // namespace limitsurf
