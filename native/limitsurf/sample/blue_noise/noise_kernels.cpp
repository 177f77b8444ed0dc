// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/noise_kernels.h"

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
#include "limitsurf/sample/blue_noise/noise_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
constexpr int kLanes = 4;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm256_sqrt_pd(a.numbers)};
}
#include "limitsurf/sample/blue_noise/noise_kernels.inl.h"
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
#include "limitsurf/sample/blue_noise/noise_kernels.inl.h"
}  // namespace avx512
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

}  // namespace

const NoiseKernels& NoiseKernels::get() {
#if LIMITSURF_X86_SETS
  return inUse(baseline::kKernels, avx2::kKernels, avx512::kKernels);
#else
  return baseline::kKernels;
#endif
}

}  // namespace limitsurf
