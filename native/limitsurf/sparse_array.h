// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace limitsurf {

/// An array of which often only a few stretches are used. Memory is taken for a stretch of 64
/// elements when one of them is first written.
template <typename T>
class SparseArray {
 public:
  explicit SparseArray(std::size_t size) : stretches_((size + kStretch - 1) / kStretch) {}

  void set(std::size_t index, const T& value) {
    std::unique_ptr<T[]>& stretch = stretches_[index / kStretch];
    if (!stretch) {
      stretch.reset(new T[kStretch]());
    }
    stretch[index % kStretch] = value;
  }
  /// An element that has been written.
  const T& operator[](std::size_t index) const {
    return stretches_[index / kStretch][index % kStretch];
  }

 private:
  static constexpr std::size_t kStretch = 64;
  std::vector<std::unique_ptr<T[]>> stretches_;
};

}  // namespace limitsurf
