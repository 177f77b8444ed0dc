// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/ray_kernels.h"

#include "limitsurf/surface/batch/instruction_sets.h"

#define LIMITSURF_KERNELS "limitsurf/search/rays/ray_kernels.inl.h"

namespace limitsurf {
namespace {

#include "limitsurf/search/kernels_of_four.inl.h"

}  // namespace

const RayKernels& RayKernels::get() { return kernelsInUse(); }

}  // namespace limitsurf
