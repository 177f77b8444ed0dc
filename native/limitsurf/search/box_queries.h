// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/search/closest_on_patch.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/wide_tree.h"

namespace limitsurf {

/// A searching point in single precision, for distances from the boxes of a tree: a box that
/// contains the point in spite of rounding.
class BoxPoint {
 public:
  /// `point` is in the coordinates of boxes.
  BoxPoint(const SearchPoint& from, const Vector3& point) : is_far_(from.isFar()) {
    const double margin = is_far_ ? 0 : kRounding * (point.cwiseAbs().maxCoeff() + 1);
    const Vector3& middle = is_far_ ? from.away : point;
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = static_cast<float>(middle[axis] - margin);
      high_[axis] = static_cast<float>(middle[axis] + margin);
    }
    twice_range_ = static_cast<float>(2 * from.range);
  }

  /// Lower bounds of the squared distances from a node's children, less the square of the range.
  WideTree::Row squaredDistances(const WideTree::Node& node) const {
    if (is_far_) {
      return squaredDistancesLess(node);
    }
    WideTree::Row squared = WideTree::Row::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      squared += (node.low[axis] - high_[axis]).max(low_[axis] - node.high[axis]).max(0.f).square();
    }
    return (squared * kNearlyOne).min(std::numeric_limits<float>::max());
  }

 private:
  WideTree::Row squaredDistancesLess(const WideTree::Node& node) const {
    WideTree::Row less = WideTree::Row::Zero(), reach = less;
    for (int axis = 0; axis < 3; ++axis) {
      const WideTree::Row nearest = node.low[axis].max(low_[axis]).min(node.high[axis]);
      less += nearest * (nearest - 2 * low_[axis]);
      reach += node.low[axis].abs().max(node.high[axis].abs());
    }
    return less - (1 - kNearlyOne) * reach * (reach + twice_range_);
  }

  /// Four units in the last place of single precision, 2^-24 each, and a little more.
  static constexpr double kRounding = 2.5e-7;
  /// Less than 1 by more than the relative rounding of the squared distance.
  static constexpr float kNearlyOne = 1 - 1e-6f;

  bool is_far_;
  float low_[3], high_[3];  // of a far point both are the way to it
  float twice_range_;
};

/// A ray prepared for intersections with the boxes of a tree, in single precision. Whatever is lost
/// by rounding is added to the boxes: a ray may be said to meet a box that it only just misses.
class BoxRay {
 public:
  explicit BoxRay(const Ray& ray) {
    const float margin = static_cast<float>(kMargin * (1 + ray.origin.cwiseAbs().maxCoeff()));
    for (int i = 0; i < 3; ++i) {
      const double rate = ray.direction[i];
      inverse_[i] = static_cast<float>(1 / (std::abs(rate) > kLeast ? rate : kLeast));
      const float origin = static_cast<float>(ray.origin[i]);
      above_[i] = origin + margin;
      below_[i] = origin - margin;
    }
  }

  /// Where the ray enters the boxes of a node's children, or a little before, but not before
  /// `begin`, and where it leaves them, but not after `end`. It meets those that it enters before
  /// it leaves them.
  void meet(const WideTree::Node& node, float begin, float end, WideTree::Row& from,
            WideTree::Row& to) const {
    from.setConstant(begin);
    to.setConstant(end);
    for (int axis = 0; axis < 3; ++axis) {
      const WideTree::Row a = (node.low[axis] - above_[axis]) * inverse_[axis],
                          b = (node.high[axis] - below_[axis]) * inverse_[axis];
      const bool forwards = inverse_[axis] > 0;
      from = from.max(forwards ? a : b);
      to = to.min(forwards ? b : a);
    }
  }

 private:
  /// Boxes lie within 4 units of the middle, so that the rounding of a difference is at most
  /// 2^-24 (4 + |origin|) for each of three roundings, and that of the product at most 2^-22 times
  /// a difference of at most 4 + |origin|: less than this part of 1 + |origin| in all.
  static constexpr double kMargin = 4e-6;
  /// Smaller components of the direction are replaced by this one: along such an axis a ray does
  /// not leave a box within any distance that matters.
  static constexpr double kLeast = 1e-20;

  float above_[3], below_[3], inverse_[3];
};

}  // namespace limitsurf
