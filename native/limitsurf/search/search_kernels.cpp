// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/search_kernels.h"

#include "limitsurf/surface/batch/instruction_sets.h"

// GCC for Windows does not align vectors of more than 16 bytes on the stack.
#if defined(__GNUC__) && defined(__x86_64__) && !(defined(_WIN32) && !defined(__clang__))
#define LIMITSURF_X86_SETS 1
#else
#define LIMITSURF_X86_SETS 0
#endif

namespace limitsurf {
namespace {

namespace baseline {
#include "limitsurf/search/search_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include "limitsurf/search/search_kernels.inl.h"
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

const SearchKernels& SearchKernels::get() {
#if LIMITSURF_X86_SETS
  if (instructionSet() != InstructionSet::baseline) {  // vectors of four: AVX-512 adds nothing
    return avx2::kKernels;
  }
#endif
  return baseline::kKernels;
}

}  // namespace limitsurf
