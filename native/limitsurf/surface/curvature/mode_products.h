// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/surface/differential.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Products of derivatives that are sums over modes, sum w_i p_i, with a weight for each derivative
/// and mode and a vector for each mode.
///
/// Deep in a ring tile the modes are of very different sizes. There du and dv may both lie along
/// the largest mode, and second derivatives lie in the plane of the two largest ones. The products
/// that normals and curvature need, du x dv and the determinants of du, dv and a second derivative,
/// then cancel out in all their large parts: products of a mode with itself. Made from the sums
/// they have no digits left. Here the products of different modes are added up, of which none is
/// wrong by more than its own rounding:
///
///     du x dv          = sum over i < j of (a_i b_j - a_j b_i) p_i x p_j
///     det(du, dv, duu) = sum over i < j < k of the minor of (a, b, c) for i, j, k
///                        times det(p_i, p_j, p_k)
///
/// for weights a of du, b of dv and c of duu. Only the kApart largest modes are treated so. What
/// remains is summed first; its product with itself is rounded to a share of its own small size.
///
/// Cost: O(modes + kApart^2) for du x dv, O(modes + kApart^3) for the determinants.
class ModeProducts {
 public:
  /// How many of the largest modes are multiplied one by one.
  static constexpr int kApart = 16;

  /// Takes first derivatives (order 1), or second ones as well (order 2).
  explicit ModeProducts(int order = 1, Eigen::Index modes = 0) : count_(order == 1 ? 2 : 5) {
    modes_.reserve(static_cast<std::size_t>(modes));
  }

  /// Adds a mode. `weights` is a column of Eigenbasis::weights(): it begins with the weight of the
  /// value, which is not needed here.
  void add(const Eigen::Ref<const Eigen::VectorXd>& weights, const Vector3& vector);

  /// Must be called after the last add() and before what follows.
  void sort();

  /// du x dv, up to a positive factor. Zero if all modes are.
  Vector3 cross() const;

  /// The condition number of the direction of cross(), which is given: what multiplies errors of
  /// the modes' vectors that are relative to the longest of them.
  double condition(const Vector3& cross) const;

  /// For order 2. The cross product is zero where its condition number exceeds
  /// kMostNormalCondition.
  FundamentalForms fundamentalForms() const;

 private:
  struct Mode {
    Vector3 vector;
    double weights[5];  ///< of du, dv; duu, duv, dvv
    double size;        ///< the largest of its shares of the derivatives
  };

  Vector3 sum(int derivative) const;
  /// The determinants of du, dv and each of duu, duv, dvv.
  Vector3 determinants() const;

  int count_;                        // how many derivatives
  std::vector<Mode> modes_;          // after sort(): the largest ones
  Vector3 rest_[5];                  // the sums over all other modes
  double rest_weights_[2] = {0, 0};  // the sums of the sizes of their weights, for du, dv
  double first_ = 1, second_ = 1, length_ = 1;  // the units of weights and vectors
};

}  // namespace limitsurf
