// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_kernels.h"

#include <cmath>

#include "limitsurf/sample/gauss_rules.h"
#include "limitsurf/surface/batch/instruction_sets.h"

#if LIMITSURF_X86_SETS
#include <immintrin.h>
#endif

namespace limitsurf {
namespace {

#define LIMITSURF_KERNELS "limitsurf/sample/area_kernels.inl.h"
#include "limitsurf/surface/batch/kernels_by_set.inl.h"

}  // namespace

const AreaKernels& AreaKernels::get() { return kernelsInUse(); }

}  // namespace limitsurf
