// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/oriented_box.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A tree of boxes around the patches between the cores of one level of a ring and those of the
/// next. Neighbouring faces share a box with axes of its own: the faces around a pole are long and
/// thin, and lie obliquely in boxes along the coordinate axes.
///
/// Boxes are relative to the vertex and in double precision, since there are levels below the
/// rounding of single precision.
class SectorTree {
 public:
  /// `cores` in the order of the ring's faces.
  SectorTree(const SurfacePatches& patches, const std::vector<SurfacePiece>& cores);

  static constexpr int kRoot = 1;
  bool isLeaf(int node) const { return node >= count_; }
  /// The place of a leaf's core among the cores.
  int core(int leaf) const { return leaf - count_; }
  /// The first child of a node; the second follows it.
  static int child(int node) { return 2 * node; }
  const CoreBox& box(int node) const { return boxes_[static_cast<std::size_t>(node)]; }

  /// A walk that puts one child aside at each node puts at most so many.
  static constexpr int kMostOpen = 64;

 private:
  int count_;
  std::vector<CoreBox> boxes_;  ///< of the nodes from 1 on; leaves come last, in the order of cores
};

}  // namespace limitsurf
