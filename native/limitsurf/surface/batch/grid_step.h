// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/ring.h"
#include "limitsurf/surface/jet.h"

namespace limitsurf {

/// Subdivides the control grid of one of a ring's faces (tile_grid.h), step by step. Every
/// instruction set takes the same operations in the same order, so that the bits are the same.
class GridStep {
 public:
  GridStep(const Ring& ring, int face);

  /// Sets the slots of the ring's points.
  void setRing(const Padded ring_points[], Padded grid[]) const {
    for (int i = 0; i < count_; ++i) {
      grid[slots_[i]] = ring_points[points_[i]];
    }
  }
  /// Sets the slots without a point, which no step changes, to 0, except that of the limit.
  void clearUnused(Padded grid[]) const;

  /// One step. `ring_points` are the ring's points after it. Slots without a point are left as they
  /// are.
  void apply(const Padded ring_points[], const Padded before[], Padded after[]) const {
    kernel_(left_, right_, before->data(), after->data());
    setRing(ring_points, after);
  }

 private:
  using Kernel = void (*)(bool left, bool right, const double* before, double* after);
  static Kernel kernel();

  const bool left_, right_;  // whether the side lies on a boundary
  int count_ = 0, slots_[tile_grid::kRingSlots.size()], points_[tile_grid::kRingSlots.size()];
  const Kernel kernel_;
};

}  // namespace limitsurf
