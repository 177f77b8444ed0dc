// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

/// Weights on points. A weight is a number, or an Eigen array of numbers.
template <typename Weight>
class PointWeights {
 public:
  struct Entry {
    int point;
    Weight weight;
  };

  /// `zero` is the weight of a point to which nothing has been added.
  explicit PointWeights(const Weight& zero) : zero_(zero) { clear(); }

  void clear() {
    entries_.clear();
    slots_.assign(kLeastSlots, {kFree, 0});
  }

  void add(int point, const Weight& weight) { entries_[find(point)].weight += weight; }

  /// In the order in which they were added, or of their points after moveToVertices().
  const std::vector<Entry>& entries() const { return entries_; }
  std::vector<Entry>& entries() { return entries_; }

  /// Replaces refined points by the control mesh's vertices, and puts these in order. Nothing can
  /// be added afterwards. Refined points come before the points that they are made of, from the
  /// last one to the first, so that each is complete when it is replaced.
  /// Cost: O(n log n) for the n points that the weights depend on.
  void moveToVertices(const RefinedPoints& points) {
    refined_.clear();
    for (const Entry& entry : entries_) {
      if (entry.point >= points.cagePoints()) {
        refined_.push_back(entry.point);
      }
    }
    std::make_heap(refined_.begin(), refined_.end());
    while (!refined_.empty()) {
      std::pop_heap(refined_.begin(), refined_.end());
      const int point = refined_.back();
      refined_.pop_back();
      const Weight weight = entries_[find(point)].weight;
      const Span<int> sources = points.sources(point);
      const Span<double> mask = points.weights(point);
      for (std::size_t i = 0; i < sources.size(); ++i) {
        const std::size_t before = entries_.size();
        add(sources[i], mask[i] * weight);
        if (entries_.size() > before && sources[i] >= points.cagePoints()) {
          refined_.push_back(sources[i]);
          std::push_heap(refined_.begin(), refined_.end());
        }
      }
    }
    entries_.erase(
        std::remove_if(entries_.begin(), entries_.end(),
                       [&](const Entry& entry) { return entry.point >= points.cagePoints(); }),
        entries_.end());
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.point < b.point; });
  }

 private:
  static constexpr int kFree = -1;
  static constexpr std::size_t kLeastSlots = 128;  // a power of two, as all numbers of slots

  struct Slot {
    int point;  ///< kFree: none
    int place;  ///< among the entries
  };

  /// The place of a point among the entries, to which it is added if it is not there.
  std::size_t find(int point) {
    std::size_t slot = slotOf(point);
    for (; slots_[slot].point != kFree; slot = slotAfter(slot)) {
      if (slots_[slot].point == point) {
        return static_cast<std::size_t>(slots_[slot].place);
      }
    }
    slots_[slot] = {point, static_cast<int>(entries_.size())};
    entries_.push_back({point, zero_});
    if (2 * entries_.size() > slots_.size()) {
      spread();
    }
    return entries_.size() - 1;
  }

  std::size_t slotOf(int point) const {
    // Neighbouring numbers, the commonest, get different slots.
    const std::uint32_t mixed = static_cast<std::uint32_t>(point) * 2654435769u;
    return (mixed ^ (mixed >> 16)) & (slots_.size() - 1);
  }
  std::size_t slotAfter(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }

  void spread() {
    slots_.assign(2 * slots_.size(), {kFree, 0});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      std::size_t slot = slotOf(entries_[i].point);
      while (slots_[slot].point != kFree) {
        slot = slotAfter(slot);
      }
      slots_[slot] = {entries_[i].point, static_cast<int>(i)};
    }
  }

  Weight zero_;
  std::vector<Entry> entries_;
  std::vector<Slot> slots_;   // places of entries by their points (open addressing)
  std::vector<int> refined_;  // points that are to be replaced (a heap)
};

}  // namespace limitsurf
