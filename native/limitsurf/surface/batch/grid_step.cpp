// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/grid_step.h"

#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/surface/batch/instruction_sets.h"

namespace limitsurf {
namespace {

namespace baseline {
using Point = Padded;
#include "limitsurf/surface/batch/grid_step.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
/// A Padded, which is aligned to 16 bytes.
typedef double Point __attribute__((vector_size(32), aligned(16), may_alias));
#include "limitsurf/surface/batch/grid_step.inl.h"
}  // namespace avx2
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

}  // namespace

GridStep::Kernel GridStep::kernel() {
#if LIMITSURF_X86_SETS
  if (instructionSet() != InstructionSet::baseline) {
    return avx2::stepOutsideRing;
  }
#endif
  return baseline::stepOutsideRing;
}

GridStep::GridStep(const Ring& ring, int face)
    : left_(onLeft(ring.sides(face))), right_(onRight(ring.sides(face))), kernel_(kernel()) {
  forEachRingSlot(ring, face, [&](int slot, int point) {
    slots_[count_] = slot;
    points_[count_++] = point;
  });
}

void GridStep::clearUnused(Padded grid[]) const {
  for (int i = 0; i < tile_grid::kSize; ++i) {
    if (left_ && i > 0) {
      grid[i].setZero();
    }
    if (right_ && i > 0) {
      grid[i * tile_grid::kSize].setZero();
    }
  }
}

}  // namespace limitsurf
