// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limitsurf/search/tree/leaf_maker.h"
#include "limitsurf/search/tree/tree_part.h"

namespace limitsurf {

/// Makes nests: the parts of a search tree below Ptex faces that have extraordinary vertices. Such
/// a face has ten times as many leaves as a regular one.
class NestBuilder {
 public:
  /// Refers to both.
  NestBuilder(const SurfacePatches& patches, const LeafMaker& maker)
      : patches_(patches), maker_(maker) {}

  /// The nest of the pieces of a face. It must have at least one leaf.
  BuiltPart build(const std::vector<SurfacePiece>& pieces) const;
  /// The number of its leaves.
  std::size_t leafCount(const std::vector<SurfacePiece>& pieces) const;

 private:
  /// What a nest is made of.
  struct Leaves {
    std::vector<LeafMaker::Leaf> leaves;
    std::vector<BezierPatch> patches;  ///< those of cores are not set
  };
  Leaves leaves(const std::vector<SurfacePiece>& pieces) const;

  const SurfacePatches& patches_;
  const LeafMaker& maker_;
};

}  // namespace limitsurf
