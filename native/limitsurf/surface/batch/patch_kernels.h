// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/batch/patch_run.h"

namespace limitsurf {

/// The inner loops of batch evaluation, compiled for one instruction set.
struct PatchKernels {
  /// Evaluates a run up to a derivative. Where a normal may have lost digits (see
  /// normalKeepsDigits()) all its numbers are NaN: the caller computes it.
  template <typename Real>
  using Evaluate = void (*)(const PatchRun& run, const PatchResults<Real>& results);

  Evaluate<double> evaluate_double[3];  ///< by the order of derivatives
  Evaluate<float> evaluate_float[3];

  template <typename Real>
  Evaluate<Real> evaluate(int order) const;

  /// The same on the grids of a ring tile.
  template <typename Real>
  using EvaluateOnGrids = void (*)(const GridRun& run, const PatchResults<Real>& results);

  EvaluateOnGrids<double> on_grids_double[3];
  EvaluateOnGrids<float> on_grids_float[3];

  template <typename Real>
  EvaluateOnGrids<Real> evaluateOnGrids(int order) const;

  /// The same on regular tiles.
  template <typename Real>
  using EvaluateSingles = void (*)(const SingleRun& run, const PatchResults<Real>& results);

  EvaluateSingles<double> singles_double[3];
  EvaluateSingles<float> singles_float[3];

  template <typename Real>
  EvaluateSingles<Real> evaluateSingles(int order) const;

  /// The same where weights are given, for positions and first derivatives.
  template <typename Real>
  using EvaluateWeighted = void (*)(const WeightedRun& run, const PatchResults<Real>& results);

  EvaluateWeighted<double> weighted_double[2];
  EvaluateWeighted<float> weighted_float[2];

  template <typename Real>
  EvaluateWeighted<Real> evaluateWeighted(int order) const;

  /// For the instruction set in use.
  static const PatchKernels& get();
};

template <>
inline PatchKernels::Evaluate<double> PatchKernels::evaluate(int order) const {
  return evaluate_double[order];
}
template <>
inline PatchKernels::Evaluate<float> PatchKernels::evaluate(int order) const {
  return evaluate_float[order];
}
template <>
inline PatchKernels::EvaluateOnGrids<double> PatchKernels::evaluateOnGrids(int order) const {
  return on_grids_double[order];
}
template <>
inline PatchKernels::EvaluateOnGrids<float> PatchKernels::evaluateOnGrids(int order) const {
  return on_grids_float[order];
}
template <>
inline PatchKernels::EvaluateSingles<double> PatchKernels::evaluateSingles(int order) const {
  return singles_double[order];
}
template <>
inline PatchKernels::EvaluateSingles<float> PatchKernels::evaluateSingles(int order) const {
  return singles_float[order];
}
template <>
inline PatchKernels::EvaluateWeighted<double> PatchKernels::evaluateWeighted(int order) const {
  return weighted_double[order];
}
template <>
inline PatchKernels::EvaluateWeighted<float> PatchKernels::evaluateWeighted(int order) const {
  return weighted_float[order];
}

}  // namespace limitsurf
