// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/frame_kernels.h"

#include <cmath>

#include "limitsurf/surface/batch/instruction_sets.h"

#if LIMITSURF_X86_SETS
#include <immintrin.h>
#endif

namespace limitsurf {
namespace {

namespace baseline {
constexpr int kLanes = 2;
template <typename Lanes>
Lanes squareRoot(const Lanes& a) {
  Lanes result = a;
  for (int i = 0; i < kLanes; ++i) {
    result.numbers[i] = std::sqrt(a.numbers[i]);
  }
  return result;
}
#include "limitsurf/surface/batch/frame_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
constexpr int kLanes = 4;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm256_sqrt_pd(a.numbers)};
}
#include "limitsurf/surface/batch/frame_kernels.inl.h"
}  // namespace avx2
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx512.inl.h"
namespace avx512 {
constexpr int kLanes = 8;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm512_maskz_sqrt_pd(0xff, a.numbers)};
}
#include "limitsurf/surface/batch/frame_kernels.inl.h"
}  // namespace avx512
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

}  // namespace

const FrameKernels& FrameKernels::get() {
#if LIMITSURF_X86_SETS
  switch (instructionSet()) {
    case InstructionSet::avx512:
      return avx512::kKernels;
    case InstructionSet::avx2:
      return avx2::kKernels;
    case InstructionSet::baseline:
      break;
  }
#endif
  return baseline::kKernels;
}

}  // namespace limitsurf
