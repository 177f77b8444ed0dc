// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/large_pages.h"

#include <algorithm>
#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace limitsurf {
namespace {

/// Less memory stays in small pages: a processor remembers that many of them.
constexpr std::size_t kLargePage = std::size_t{1} << 21;

std::size_t rounded(std::size_t bytes) {
  return bytes < kLargePage ? bytes : (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

std::align_val_t alignmentOf(std::size_t bytes, std::size_t alignment) {
  return std::align_val_t(bytes < kLargePage ? alignment : std::max(alignment, kLargePage));
}

}  // namespace

void* allocateLargePages(std::size_t bytes, std::size_t alignment) {
  void* const memory = ::operator new(rounded(bytes), alignmentOf(bytes, alignment));
  askForLargePages(memory, rounded(bytes));
  return memory;
}

void freeLargePages(void* memory, std::size_t bytes, std::size_t alignment) noexcept {
  ::operator delete(memory, alignmentOf(bytes, alignment));
}

void askForLargePages(void* memory, std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  const auto first = reinterpret_cast<std::uintptr_t>(memory), last = first + bytes;
  const std::uintptr_t begin = (first + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = last / kLargePage * kLargePage;
  if (begin < end) {
    // A system that refuses leaves the pages as they are.
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }
#else
  (void)memory;
  (void)bytes;
#endif
}

}  // namespace limitsurf
