// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/batch/patch_run.h"

namespace limitsurf {

/// The inner loops of batch evaluation with results in one precision, by the order of derivatives.
/// Each evaluates a run. Where a normal may have lost digits (see normalKeepsDigits()) all its
/// numbers are NaN: the caller computes it.
template <typename Real>
struct PatchKernelsOf {
  using Results = PatchResults<Real>;

  void (*patches[3])(const PatchRun&, const Results&);
  void (*on_grids[3])(const GridRun&, const Results&);  ///< of a ring tile
  void (*singles[3])(const SingleRun&, const Results&);
  void (*weighted[2])(const WeightedRun&, const Results&);
};

/// The inner loops, compiled for one instruction set.
struct PatchKernels {
  PatchKernelsOf<double> in_double;
  PatchKernelsOf<float> in_float;

  /// For the instruction set in use.
  static const PatchKernels& get();
  template <typename Real>
  static const PatchKernelsOf<Real>& of() {
    if constexpr (std::is_same_v<Real, double>) {
      return get().in_double;
    } else {
      return get().in_float;
    }
  }
};

}  // namespace limitsurf
