// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "limitsurf/unset_vector.h"

// Large pages of memory: 2 MiB instead of 4 KiB, where the system has them (Linux). A processor
// remembers where some two thousand pages are; to read from megabytes of small ones in no
// particular order, it has to look most of them up. And memory that is written to for the first
// time comes page by page from the system, which takes less time for a large one than for as many
// small ones.
namespace limitsurf {

/// Memory in large pages where it is large enough. It is rounded up to whole pages then. Throws
/// std::bad_alloc.
void* allocateLargePages(std::size_t bytes, std::size_t alignment);
/// Frees what allocateLargePages() has returned for these numbers.
void freeLargePages(void* memory, std::size_t bytes, std::size_t alignment) noexcept;

/// An UnsetAllocator for vectors that are read in no particular order.
template <typename T>
class LargePageAllocator : public UnsetAllocator<T> {
 public:
  template <typename U>
  struct rebind {
    using other = LargePageAllocator<U>;
  };

  LargePageAllocator() = default;
  template <typename U>
  LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(allocateLargePages(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    freeLargePages(memory, count * sizeof(T), alignof(T));
  }
};

template <typename T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

/// Asks for large pages inside memory that has not been written to yet.
void askForLargePages(void* memory, std::size_t bytes);

/// Gives a matrix this number of rows, without values.
template <typename Matrix>
void resizeRows(Matrix& matrix, std::size_t rows) {
  matrix.resize(static_cast<Eigen::Index>(rows), matrix.cols());
  askForLargePages(matrix.data(),
                   static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar));
}

}  // namespace limitsurf
