// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// An array that grows at its end, in parts of 1 MiB. A full part is never moved, so that growing
/// takes no more memory than the elements do, while a vector holds them twice when it moves them.
template <typename T>
class PartArray {
 public:
  /// The most elements that can lie next to each other.
  static constexpr std::size_t mostTogether() { return kPart; }

  /// Appends elements that will lie next to each other, and returns the index of the first one.
  /// Where the last part has too little room for them, some indices are skipped.
  std::size_t append(const T* elements, std::size_t count) {
    if (parts_.empty() || count > parts_.back().capacity() - parts_.back().size()) {
      makeRoom(count);
    }
    std::vector<T>& part = parts_.back();
    const std::size_t index = ((parts_.size() - 1) << kPartBits) + part.size();
    if (count <= kFew) {
      for (std::size_t i = 0; i < count; ++i) {
        part.push_back(elements[i]);
      }
    } else {
      part.insert(part.end(), elements, elements + count);
    }
    return index;
  }
  void push_back(const T& element) {
    if (parts_.empty() || parts_.back().size() == parts_.back().capacity()) {
      makeRoom(1);
    }
    parts_.back().push_back(element);
  }

  const T& operator[](std::size_t index) const {
    return parts_[index >> kPartBits][index & (kPart - 1)];
  }
  /// The number of elements if all were appended one by one.
  std::size_t size() const {
    return parts_.empty() ? 0 : ((parts_.size() - 1) << kPartBits) + parts_.back().size();
  }

  /// Moves the elements to the end of a vector that has room for them. What is moved is freed part
  /// by part.
  void moveTo(std::vector<T>& to) {
    for (std::vector<T>& part : parts_) {
      to.insert(to.end(), part.begin(), part.end());
      part = {};
      InterruptionPoint::pass();
    }
    parts_ = {};
  }

  /// Frees the room for more elements.
  void shrink() {
    if (!parts_.empty()) {
      parts_.back().shrink_to_fit();
    }
  }

 private:
  /// Inserting fewer as a range takes longer than one by one.
  static constexpr std::size_t kFew = 6;

  static constexpr int bitsOf(std::size_t bytes) {
    int bits = 0;
    while ((sizeof(T) << (bits + 1)) <= bytes) {
      ++bits;
    }
    return bits;
  }
  static constexpr int kPartBits = bitsOf(std::size_t{1} << 20);
  static constexpr std::size_t kPart = std::size_t{1} << kPartBits;

  void makeRoom(std::size_t count) {
    if (count > kPart) {
      throw std::length_error("more elements next to each other than fit into a part");
    }
    if (parts_.empty() || count > kPart - parts_.back().size()) {
      parts_.emplace_back();
    }
    std::vector<T>& part = parts_.back();
    // Small arrays take little memory; the system hands out that of large ones when it is used.
    const std::size_t wanted =
        parts_.size() > 1 ? kPart : std::max(2 * part.size(), part.size() + count);
    part.reserve(std::min(wanted, kPart));
  }

  std::vector<std::vector<T>> parts_;
};

}  // namespace limitsurf
