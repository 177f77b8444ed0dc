// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/sample/blue_noise/noise_disc.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Places of one patch, side by side, and what the surface is there.
struct PlaceBlock {
  static constexpr int kCount = 8;

  double s[kCount], t[kCount];
  double position[3][kCount];
  double normal[3][kCount];  ///< a unit vector
  double area[kCount];       ///< |ds x dt|
};

/// Upper bounds of the lengths of a patch's derivatives.
struct DerivativeBounds {
  double ds = 0, dt = 0, dss = 0, dst = 0, dtt = 0;
};

/// Rectangles of one patch's parameters, side by side, and bounds on the surface over them: the
/// members of CellExtent.
struct ExtentBlock {
  static constexpr int kCount = PlaceBlock::kCount;

  double s[kCount], t[kCount];  ///< the middle
  double half_width[kCount], half_height[kCount];
  double middle[3][kCount];
  double normal[3][kCount];  ///< ds x dt in the middle
  double half_s[3][kCount], half_t[3][kCount];
  double along_s[kCount], along_t[kCount], corner[kCount], bend[kCount];
  double normal_length[kCount], normal_reach[kCount];
};

/// Parts of a cell, of each of which it is asked whether one disc covers it: whether each of its
/// points is in conflict with the disc.
struct CellParts {
  static constexpr int kMost = 5;  ///< a cell and its quarters

  int count = 0;
  double middle[3][kMost], reach[kMost];  ///< no point of the part is farther from its middle
  double smallest;                        ///< the smallest radius in the cell
  /// ds x dt differs from `normal` by at most `normal_reach`; unit vectors whose scalar product
  /// with `normal`, less that, is above `least` are less than 90 degrees from all of them.
  double normal[3], normal_reach, least;

  void add(const Vector3& part_middle, double part_reach) {
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis][count] = part_middle[axis];
    }
    reach[count++] = part_reach;
  }
};

/// Trials of blue noise, many at once, compiled for one instruction set. Results do not depend on
/// the set.
struct NoiseKernels {
  void (*places)(const BezierPatch& patch, PlaceBlock& block);
  void (*extents)(const BezierPatch& patch, const DerivativeBounds& bounds, ExtentBlock& block);
  /// Whether any disc is in conflict with the disc `own`, sees it, and comes before it: has a lower
  /// rank, or the same rank and a lower number.
  bool (*conflict)(const DiscBlock* blocks, std::size_t count, const NoiseDisc& own, double number);
  /// A bit for each part that a disc covers.
  unsigned (*covered)(const DiscBlock* blocks, std::size_t count, const CellParts& parts);

  /// For the instruction set in use.
  static const NoiseKernels& get();
};

}  // namespace limitsurf
