// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "limitsurf/parallel.h"

namespace limitsurf {

BoxF BoxF::empty() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  BoxF box;
  box.low << kInfinity, kInfinity, kInfinity, 0;
  box.high << -kInfinity, -kInfinity, -kInfinity, 0;
  return box;
}

BoxF::BoxF(const Box& box) : BoxF(empty()) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; ++i) {
    low[i] = std::nextafter(static_cast<float>(box.low[i]), -kInfinity);
    high[i] = std::nextafter(static_cast<float>(box.high[i]), kInfinity);
  }
}

void BoxF::include(const BoxF& box) {
  low = low.min(box.low);
  high = high.max(box.high);
}

float BoxF::halfArea() const {
  const Corner size = high - low;
  return size[0] < 0 ? 0 : size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

class BoxTree::Builder {
 public:
  Builder(const std::vector<BoxF>& leaves, std::vector<std::int32_t>& order,
          UnsetVector<Node>& nodes)
      : leaves_(leaves), order_(order), nodes_(nodes) {
    order_.resize(leaves.size());
    std::iota(order_.begin(), order_.end(), 0);
  }

  void build(int threads) {
    if (leaves_.empty()) {
      return;
    }
    const Part all{0, static_cast<std::int32_t>(leaves_.size()), 0, 1};
    if (all.size() == 1) {
      nodes_.push_back({{leaves_[0], BoxF::empty()}, {~0, ~0}});
      return;
    }
    nodes_.resize(leaves_.size() - 1);
    if (all.size() <= kLeavesPerTask) {
      setNodes(all);
      return;
    }
    // Large parts are divided one level of the tree after the other, and each of the others is left
    // to one thread.
    std::vector<Part> large{all}, halves, whole;
    while (!large.empty()) {
      halves.resize(2 * large.size());
      parallelFor(large.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          setNode(large[i], &halves[2 * i]);
        }
      });
      large.clear();
      for (const Part& half : halves) {
        if (half.size() > kLeavesPerTask) {
          large.push_back(half);
        } else if (half.size() > 1) {
          whole.push_back(half);
        }
      }
    }
    parallelFor(whole.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        setNodes(whole[i]);
      }
    });
  }

 private:
  /// The number of bins that centres are sorted into.
  static constexpr int kBins = 16;
  /// Parts at this depth and below are cut into halves of equal number, which reach single leaves
  /// within 32 more levels.
  static constexpr int kHeuristicDepth = kMostDepth - 32;
  /// The leaves of a part that one thread divides to the end: a millisecond.
  static constexpr std::int32_t kLeavesPerTask = 1 << 12;

  /// Some of the leaves and, if they are more than one, the node over them and its depth.
  struct Part {
    std::int32_t begin, end, node;
    int depth;
    std::int32_t size() const { return end - begin; }
  };

  /// Sets the node over a part, and all nodes below it.
  void setNodes(const Part& part) {
    Part halves[2];
    setNode(part, halves);
    for (const Part& half : halves) {
      if (half.size() > 1) {
        setNodes(half);
      }
    }
  }

  /// Divides a part of two or more leaves, and sets the node over it.
  void setNode(const Part& part, Part halves[2]) {
    const std::int32_t middle = divide(part);
    halves[0] = {part.begin, middle, part.node + 1, part.depth + 1};
    halves[1] = {middle, part.end, part.node + halves[0].size(), part.depth + 1};
    Node& node = nodes_[static_cast<std::size_t>(part.node)];
    for (int side = 0; side < 2; ++side) {
      const Part& half = halves[side];
      BoxF box = BoxF::empty();
      for (std::int32_t i = half.begin; i < half.end; ++i) {
        box.include(leaves_[order_[i]]);
      }
      node.boxes[side] = box;
      node.children[side] = half.size() == 1 ? ~half.begin : half.node;
    }
  }

  /// Twice the centre of a leaf's box.
  float centre(std::int32_t leaf, int axis) const {
    return leaves_[leaf].low[axis] + leaves_[leaf].high[axis];
  }

  /// Sorts a part of two or more leaves into two halves, neither of them empty, and returns where
  /// the second begins.
  std::int32_t divide(const Part& part) {
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::numeric_limits<float>::infinity();
      high[axis] = -low[axis];
      for (std::int32_t i = part.begin; i < part.end; ++i) {
        low[axis] = std::min(low[axis], centre(order_[i], axis));
        high[axis] = std::max(high[axis], centre(order_[i], axis));
      }
    }
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
      axis = high[i] - low[i] > high[axis] - low[axis] ? i : axis;
    }
    // It is infinite where the centres hardly differ, and NaN where their distance overflows.
    const float scale = kBins / (high[axis] - low[axis]);
    if (part.size() > 2 && part.depth < kHeuristicDepth && scale > 0 && std::isfinite(scale)) {
      const std::int32_t middle = divideByArea(part, axis, low[axis], scale);
      if (middle > part.begin && middle < part.end) {
        return middle;
      }
    }
    const std::int32_t middle = part.begin + part.size() / 2;
    std::nth_element(order_.begin() + part.begin, order_.begin() + middle,
                     order_.begin() + part.end, [&](std::int32_t a, std::int32_t b) {
                       const float x = centre(a, axis), y = centre(b, axis);
                       return x != y ? x < y : a < b;
                     });
    return middle;
  }

  /// The same by the surface area heuristic along one axis; a half may be empty.
  std::int32_t divideByArea(const Part& part, int axis, float low, float scale) {
    const auto bin = [&](std::int32_t leaf) {
      return std::clamp(static_cast<int>((centre(leaf, axis) - low) * scale), 0, kBins - 1);
    };
    BoxF boxes[kBins];
    std::fill(boxes, boxes + kBins, BoxF::empty());
    std::int32_t counts[kBins] = {};
    for (std::int32_t i = part.begin; i < part.end; ++i) {
      const int b = bin(order_[i]);
      boxes[b].include(leaves_[order_[i]]);
      ++counts[b];
    }
    float right_costs[kBins];
    BoxF right = BoxF::empty();
    std::int32_t right_count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      right.include(boxes[b]);
      right_count += counts[b];
      right_costs[b] = right.halfArea() * static_cast<float>(right_count);
    }
    BoxF left = BoxF::empty();
    std::int32_t left_count = 0;
    float best = std::numeric_limits<float>::infinity();
    int cut = 0;
    for (int b = 1; b < kBins; ++b) {
      left.include(boxes[b - 1]);
      left_count += counts[b - 1];
      const float cost = left.halfArea() * static_cast<float>(left_count) + right_costs[b];
      if (left_count > 0 && left_count < part.size() && cost < best) {
        best = cost;
        cut = b;
      }
    }
    const auto middle = std::partition(order_.begin() + part.begin, order_.begin() + part.end,
                                       [&](std::int32_t leaf) { return bin(leaf) < cut; });
    return static_cast<std::int32_t>(middle - order_.begin());
  }

  const std::vector<BoxF>& leaves_;
  std::vector<std::int32_t>& order_;
  UnsetVector<Node>& nodes_;
};

BoxTree::BoxTree(const std::vector<BoxF>& leaves, std::vector<std::int32_t>& order, int threads)
    : leaf_count_(static_cast<std::int32_t>(leaves.size())) {
  Builder(leaves, order, nodes_).build(threads);
}

}  // namespace limitsurf
