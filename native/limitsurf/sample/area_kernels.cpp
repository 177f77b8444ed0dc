// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_kernels.h"

#include <cmath>

#include "limitsurf/sample/gauss_rules.h"
#include "limitsurf/surface/batch/instruction_sets.h"

// GCC for Windows does not align vectors of more than 16 bytes on the stack.
#if defined(__GNUC__) && defined(__x86_64__) && !(defined(_WIN32) && !defined(__clang__))
#define LIMITSURF_X86_SETS 1
#include <immintrin.h>
#else
#define LIMITSURF_X86_SETS 0
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
#include "limitsurf/sample/area_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
constexpr int kLanes = 4;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm256_sqrt_pd(a.numbers)};
}
#include "limitsurf/sample/area_kernels.inl.h"
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl"))), \
                             apply_to = function)
#else
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif
namespace avx512 {
constexpr int kLanes = 8;
template <typename Lanes>
inline Lanes squareRoot(const Lanes& a) {
  return {_mm512_maskz_sqrt_pd(0xff, a.numbers)};
}
#include "limitsurf/sample/area_kernels.inl.h"
}  // namespace avx512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif

}  // namespace

const AreaKernels& AreaKernels::get() {
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
