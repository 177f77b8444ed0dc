// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/ray_kernels.h"

#include "limitsurf/surface/batch/instruction_sets.h"

namespace limitsurf {
namespace {

namespace baseline {
#include "limitsurf/search/rays/ray_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
#include "limitsurf/search/rays/ray_kernels.inl.h"
}  // namespace avx2
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

}  // namespace

const RayKernels& RayKernels::get() {
#if LIMITSURF_X86_SETS
  if (instructionSet() != InstructionSet::baseline) {  // vectors of four: AVX-512 adds nothing
    return avx2::kKernels;
  }
#endif
  return baseline::kKernels;
}

}  // namespace limitsurf
