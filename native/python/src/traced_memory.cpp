// SPDX-License-Identifier: Apache-2.0
#include "traced_memory.h"

#include <cstdint>

// Python.h of 3.11 declares them without extern "C", so that C++ would look for other names: this
// file does without it.
extern "C" {
int PyTraceMalloc_Track(unsigned domain, std::uintptr_t memory, std::size_t size);
int PyTraceMalloc_Untrack(unsigned domain, std::uintptr_t memory);
}

namespace limitsurf::python {
namespace {

/// numpy's own, np.lib.tracemalloc_domain.
constexpr unsigned kDomain = 389047;

}  // namespace

void traceMemory(const void* memory, std::size_t bytes) {
  PyTraceMalloc_Track(kDomain, reinterpret_cast<std::uintptr_t>(memory), bytes);
}

void untraceMemory(const void* memory) {
  PyTraceMalloc_Untrack(kDomain, reinterpret_cast<std::uintptr_t>(memory));
}

}  // namespace limitsurf::python
