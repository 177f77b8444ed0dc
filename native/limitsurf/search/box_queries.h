// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/search/closest_so_far.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/wide_tree.h"

namespace limitsurf {

/// A searching point in single precision, for distances from the boxes of a tree: a box that
/// contains the point in spite of rounding.
class BoxPoint {
 public:
  using Row = WideTree::Row;

  /// `point` is in the coordinates of boxes. The rounding of boxes is bounded by that of 1, their
  /// unit, or with `is_crowd` more closely: the rounding of a box whose coordinates are larger than
  /// the point's is a small part of their distance.
  BoxPoint(const SearchPoint& from, const Vector3& point, bool is_crowd) : is_far_(from.isFar()) {
    const double least = is_crowd ? kTiny : 1;
    const double margin = is_far_ ? 0 : kRounding * (point.cwiseAbs().maxCoeff() + least);
    const Vector3& middle = is_far_ ? from.away : point;
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis].setConstant(static_cast<float>(middle[axis] - margin));
      high_[axis].setConstant(static_cast<float>(middle[axis] + margin));
    }
    twice_range_ = static_cast<float>(2 * from.range);
  }

  /// Lower bounds of the squared distances from a node's children, less the square of the range.
  Row squaredDistances(const WideTree::Node& node) const {
    if (is_far_) {
      return squaredDistancesLess(node);
    }
    Row squared = Row::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Row &low = node.bounds[axis][0], &high = node.bounds[axis][1];
      squared += (low - high_[axis]).max(low_[axis] - high).max(0.f).square();
    }
    return (squared * kNearlyOne).min(std::numeric_limits<float>::max());
  }

  /// Numbers by which a search chooses which child of a node to visit first: the bounds and the
  /// squared distances of the middles. Where many boxes contain the point, as those of slivers do,
  /// the bounds alone do not tell which is nearest.
  Row nearness(const WideTree::Node& node, const Row& bounds) const {
    if (is_far_) {
      return bounds;
    }
    Row squared = Row::Zero();  // of twice the distances
    for (int axis = 0; axis < 3; ++axis) {
      squared +=
          ((node.bounds[axis][0] - low_[axis]) + (node.bounds[axis][1] - high_[axis])).square();
    }
    return bounds + 0.25f * squared;
  }

 private:
  Row squaredDistancesLess(const WideTree::Node& node) const {
    Row less = Row::Zero(), reach = less;
    for (int axis = 0; axis < 3; ++axis) {
      const Row &low = node.bounds[axis][0], &high = node.bounds[axis][1];
      const Row nearest = low.max(low_[axis]).min(high);
      less += nearest * (nearest - 2 * low_[axis]);
      reach += low.abs().max(high.abs());
    }
    return less - (1 - kNearlyOne) * reach * (reach + twice_range_);
  }

  /// Four units in the last place of single precision, 2^-24 each, and a little more.
  static constexpr double kRounding = 2.5e-7;
  /// This part of it is more than the rounding of points in double precision.
  static constexpr double kTiny = 1e-8;
  /// Less than 1 by more than the relative rounding of the squared distance.
  static constexpr float kNearlyOne = 1 - 1e-6f;

  bool is_far_;
  Row low_[3], high_[3];  // the same number four times; of a far point both are the way to it
  float twice_range_;
};

/// A ray prepared for intersections with the boxes of a tree, in single precision. Whatever is lost
/// by rounding is added to the boxes: a ray may be said to meet a box that it only just misses.
class BoxRay {
 public:
  using Row = WideTree::Row;

  BoxRay() = default;
  explicit BoxRay(const Ray& ray) {
    const float margin = static_cast<float>(kMargin * (1 + ray.origin.cwiseAbs().maxCoeff()));
    for (int i = 0; i < 3; ++i) {
      const double rate = ray.direction[i];
      const auto inverse = static_cast<float>(1 / (std::abs(rate) > kLeast ? rate : kLeast));
      const auto origin = static_cast<float>(ray.origin[i]);
      const bool forwards = inverse > 0;
      first_[i] = forwards ? 0 : 1;
      inverse_[i].setConstant(inverse);
      enter_[i].setConstant(forwards ? origin + margin : origin - margin);
      leave_[i].setConstant(forwards ? origin - margin : origin + margin);
    }
  }

  /// Returns a bit for each of a node's children whose box the ray meets between `begin` and `end`,
  /// and where it enters the boxes, or a little before.
  unsigned meet(const WideTree::Node& node, float begin, float end, Row& from) const {
    from.setConstant(begin);
    Row to = Row::Constant(end);
    for (int axis = 0; axis < 3; ++axis) {
      const Row* const ends = node.bounds[axis];
      from = from.max((ends[first_[axis]] - enter_[axis]) * inverse_[axis]);
      to = to.min((ends[1 - first_[axis]] - leave_[axis]) * inverse_[axis]);
    }
    return WideTree::children(node, [&](int child) { return from[child] <= to[child]; });
  }

 private:
  /// Boxes lie within 4 units of the middle, so that the rounding of a difference is at most
  /// 2^-24 (4 + |origin|) for each of three roundings, and that of the product at most 2^-22 times
  /// a difference of at most 4 + |origin|: less than this part of 1 + |origin| in all.
  static constexpr double kMargin = 4e-6;
  /// Smaller components of the direction are replaced by this one: along such an axis a ray does
  /// not leave a box within any distance that matters.
  static constexpr double kLeast = 1e-20;

  int first_[3];                          // the end of a box at which the ray enters, 0 or 1
  Row enter_[3], leave_[3], inverse_[3];  // the same number four times
};

}  // namespace limitsurf
