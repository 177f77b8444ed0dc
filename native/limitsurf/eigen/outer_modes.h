// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "limitsurf/eigen/tile_grid.h"
#include "limitsurf/precision/double_double_eigen.h"

namespace limitsurf {

/// The eigenvectors that vanish on the ring, continued to the whole grid: those of S12, the columns
/// of W1 in Lacewell & Burley 2007, section 3.1.
///
/// S12 does not depend on the valence and is diagonalisable. Its eigenvalues are 1/8 and 1/16, each
/// twice, 1/32 once for each side of the face that lies inside the sector, and 1/64.
template <typename Real>
class OuterModes {
 public:
  using Matrix =
      Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, tile_grid::kOuter, tile_grid::kSlots>;

  explicit OuterModes(Sides sides);

  /// The same modes, rounded.
  template <typename Wider>
  explicit OuterModes(const OuterModes<Wider>& other)
      : sides_(other.sides()),
        step_(sides_),
        slots_(other.slots()),
        s11_(other.s11().template cast<Real>()),
        s12_(other.s12().template cast<Real>()),
        vectors_(other.vectors().template cast<Real>()),
        inverse_(other.inverse().template cast<Real>()) {
    for (int q = 0; q < other.count(); ++q) {
      lambda_.push_back(static_cast<Real>(other.lambda(q)));
    }
  }

  Sides sides() const { return sides_; }
  int count() const { return static_cast<int>(lambda_.size()); }
  /// The grid slots of the count() outer points.
  const std::vector<int>& slots() const { return slots_; }
  Real lambda(int q) const { return lambda_[q]; }
  const Matrix& vectors() const { return vectors_; }  ///< W1: one column per mode
  const Matrix& inverse() const { return inverse_; }  ///< W1^-1
  const Matrix& s11() const { return s11_; }          ///< outer from ring slots (columns by slot)
  const Matrix& s12() const { return s12_; }
  const TileStep<Real>& step() const { return step_; }

 private:
  Sides sides_;
  TileStep<Real> step_;
  std::vector<int> slots_;
  std::vector<Real> lambda_;
  Matrix s11_, s12_, vectors_, inverse_;
};

extern template class OuterModes<double>;
extern template class OuterModes<DoubleDouble>;

}  // namespace limitsurf
