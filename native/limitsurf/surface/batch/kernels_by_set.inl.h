// SPDX-License-Identifier: Apache-2.0
//
// Compiles the kernels of the file LIMITSURF_KERNELS for each instruction set. To be included in an
// unnamed namespace, after <cmath>, instruction_sets.h and, with LIMITSURF_X86_SETS, <immintrin.h>.
// Each time, kLanes is the number of doubles in a vector, and squareRoot() is that of all lanes.

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
#include LIMITSURF_KERNELS
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
constexpr int kLanes = 4;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm256_sqrt_pd(a.numbers)};
}
#include LIMITSURF_KERNELS
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
#include LIMITSURF_KERNELS
}  // namespace avx512
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

/// The kernels for the set in use.
inline const auto& kernelsInUse() {
#if LIMITSURF_X86_SETS
  return inUse(&baseline::kKernels, &avx2::kKernels, &avx512::kKernels);
#else
  return baseline::kKernels;
#endif
}
