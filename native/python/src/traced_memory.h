// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limitsurf::python {

/// Tell Python's module tracemalloc about the memory of an array, as numpy does. They take a few
/// nanoseconds while nobody traces. The thread must hold the GIL.
void traceMemory(const void* memory, std::size_t bytes);
void untraceMemory(const void* memory);

}  // namespace limitsurf::python
