// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace limitsurf {

/// An array whose size does not change, without memory of its own as long as it has few elements:
/// most vertices have few edges.
template <typename T>
class SmallArray {
 public:
  SmallArray() = default;
  explicit SmallArray(std::size_t size, const T& value = T()) : size_(size) {
    if (size > kFew) {
      many_.assign(size, value);
    } else {
      std::fill_n(few_.begin(), size, value);
    }
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return size_ > kFew ? many_.data() : few_.data(); }
  const T* data() const { return size_ > kFew ? many_.data() : few_.data(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  const T& front() const { return data()[0]; }
  const T& back() const { return data()[size_ - 1]; }

 private:
  static constexpr std::size_t kFew = 8;

  std::size_t size_ = 0;
  std::array<T, kFew> few_{};
  std::vector<T> many_;
};

}  // namespace limitsurf
