// SPDX-License-Identifier: Apache-2.0
//
// Compiles the kernels of the file LIMITSURF_KERNELS, which work on vectors of four numbers, for
// the baseline and for AVX2: AVX-512 would add nothing. To be included in an unnamed namespace,
// after instruction_sets.h.

namespace baseline {
#include LIMITSURF_KERNELS
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
#include LIMITSURF_KERNELS
}  // namespace avx2
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

/// The kernels for the set in use.
inline const auto& kernelsInUse() {
#if LIMITSURF_X86_SETS
  return inUse(&baseline::kKernels, &avx2::kKernels, &avx2::kKernels);
#else
  return baseline::kKernels;
#endif
}
