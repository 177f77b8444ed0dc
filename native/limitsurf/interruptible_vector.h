// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "limitsurf/interruption_point.h"

// It takes seconds to copy a vector of gigabytes, or to give it memory. These functions do so in
// parts, with an interruption point after each.
namespace limitsurf {

/// Moves values to the end of a vector that has room for them. That takes long where there are
/// many, because the system hands out memory when it is first written to, and can be interrupted.
template <typename T>
void moveInParts(std::vector<T>& from, std::vector<T>& to) {
  constexpr std::size_t kPart = std::size_t{1} << 16;
  for (std::size_t begin = 0; begin < from.size(); begin += kPart) {
    T* const first = from.data() + begin;
    T* const last = from.data() + std::min(begin + kPart, from.size());
    to.insert(to.end(), std::make_move_iterator(first), std::make_move_iterator(last));
    InterruptionPoint::pass();
  }
}

/// Gives a vector room for `capacity` values, at least as many as it has. Can be interrupted.
template <typename T>
void reallocate(std::vector<T>& values, std::size_t capacity) {
  std::vector<T> other;
  other.reserve(capacity);
  moveInParts(values, other);
  values.swap(other);
}

/// Adds values that T() makes to the end of a vector, until it has `count`. Can be interrupted.
template <typename T>
void resizeInParts(std::vector<T>& values, std::size_t count) {
  constexpr std::size_t kPart = std::size_t{1} << 16;
  values.reserve(count);
  while (values.size() < count) {
    values.resize(std::min(values.size() + kPart, count));
    InterruptionPoint::pass();
  }
}

/// Makes room for `count` more values, and twice as much where the vector must move. Can be
/// interrupted.
template <typename T>
void reserveMore(std::vector<T>& values, std::size_t count) {
  if (count > values.capacity() - values.size()) {
    reallocate(values, std::max(2 * values.capacity(), values.size() + count));
  }
}

/// Frees the room for more values. Can be interrupted.
template <typename T>
void shrinkToSize(std::vector<T>& values) {
  if (values.capacity() > values.size()) {
    reallocate(values, values.size());
  }
}

}  // namespace limitsurf
