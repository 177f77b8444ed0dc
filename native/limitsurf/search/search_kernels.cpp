// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/search_kernels.h"

#include "limitsurf/surface/batch/instruction_sets.h"

#define LIMITSURF_KERNELS "limitsurf/search/search_kernels.inl.h"

namespace limitsurf {
namespace {

#include "limitsurf/search/kernels_of_four.inl.h"

}  // namespace

const SearchKernels& SearchKernels::get() { return kernelsInUse(); }

}  // namespace limitsurf
