// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/row_inverse.h"

#include <cmath>

#include "limitsurf/surface/batch/instruction_sets.h"

#if LIMITSURF_X86_SETS
#include <immintrin.h>
#endif

namespace limitsurf {
namespace {

#define LIMITSURF_KERNELS "limitsurf/uv/row_inverse.inl.h"
#include "limitsurf/surface/batch/kernels_by_set.inl.h"

}  // namespace

const RowInverse& RowInverse::get() { return kernelsInUse(); }

}  // namespace limitsurf
