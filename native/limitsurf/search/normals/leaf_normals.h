// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/normals/piece_normals.h"
#include "limitsurf/search/tree/search_tree.h"
#include "limitsurf/surface/patches/settling_cores.h"

namespace limitsurf {

/// What is known of the normals of the leaves of a search tree.
class LeafNormals {
 public:
  /// Refers to the tree.
  explicit LeafNormals(const SearchTree& tree);

  /// That of a patch, of a core down to its vertex, or of all cores around a vertex with many
  /// faces. May be called from many threads at once.
  PieceNormals of(const SurfacePiece& leaf) const;

 private:
  DirectionCone coneOfCore(SurfacePiece core) const;
  DirectionCone coneOfRing(const SurfacePiece& first) const;
  /// Sets what is known of the borders of a core.
  void setBorder(const SurfacePiece& core, PieceNormals& piece) const;

  const SearchTree& tree_;
  SettlingCores settling_;
};

}  // namespace limitsurf
