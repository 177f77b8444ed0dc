// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// Lists of the triangles at each point, in which corners can be moved from one point to another.
/// The lists are linked within a few arrays: one that has its own memory for each point would take
/// most of a second to free where there are millions.
class TrianglesAround {
 public:
  /// Iterates over numbers of triangles.
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = int;
    using difference_type = std::ptrdiff_t;
    using pointer = const int*;
    using reference = int;

    Iterator(const std::vector<int>& next, int corner) : next_(&next), corner_(corner) {}
    int operator*() const { return corner_ / 3; }
    Iterator& operator++() {
      corner_ = (*next_)[static_cast<std::size_t>(corner_)];
      return *this;
    }
    bool operator==(const Iterator& other) const { return corner_ == other.corner_; }
    bool operator!=(const Iterator& other) const { return corner_ != other.corner_; }

   private:
    const std::vector<int>* next_;
    int corner_;
  };

  class Range {
   public:
    Range(Iterator begin, Iterator end) : begin_(begin), end_(end) {}
    Iterator begin() const { return begin_; }
    Iterator end() const { return end_; }

   private:
    Iterator begin_, end_;
  };

  /// `vertices` are the points of each triangle, fewer than `points`.
  TrianglesAround(std::size_t points, const std::vector<std::array<int, 3>>& vertices)
      : ends_(points) {
    next_.reserve(3 * vertices.size());
    InterruptionStride stride;
    for (const std::array<int, 3>& triangle : vertices) {
      stride.step();
      addTriangle(triangle);
    }
  }

  /// The triangles at a point, in the order in which they got there. Changes of its list make the
  /// range invalid.
  Range operator[](int point) const {
    return {{next_, ends_[static_cast<std::size_t>(point)].first}, {next_, kNone}};
  }

  void addPoint() { ends_.emplace_back(); }
  /// Adds a triangle with these points, after all others.
  void addTriangle(const std::array<int, 3>& points) {
    for (const int point : points) {
      next_.push_back(kNone);
      append(static_cast<int>(next_.size()) - 1, point);
    }
  }
  /// Moves a corner of a triangle from one point to another.
  void moveCorner(int triangle, int corner, int from, int to) {
    const int moved = 3 * triangle + corner;
    Ends& ends = ends_[static_cast<std::size_t>(from)];
    int before = kNone;
    for (int at = ends.first; at != moved; at = next_[static_cast<std::size_t>(at)]) {
      before = at;
    }
    int& next = next_[static_cast<std::size_t>(moved)];
    (before == kNone ? ends.first : next_[static_cast<std::size_t>(before)]) = next;
    if (ends.last == moved) {
      ends.last = before;
    }
    next = kNone;
    append(moved, to);
  }

 private:
  static constexpr int kNone = -1;

  struct Ends {
    int first = kNone, last = kNone;  // corners: 3 times the triangle's number, and 0, 1 or 2
  };

  void append(int corner, int point) {
    Ends& ends = ends_[static_cast<std::size_t>(point)];
    (ends.last == kNone ? ends.first : next_[static_cast<std::size_t>(ends.last)]) = corner;
    ends.last = corner;
  }

  std::vector<Ends> ends_;  // per point
  std::vector<int> next_;   // per corner: the next one at its point
};

}  // namespace limitsurf
