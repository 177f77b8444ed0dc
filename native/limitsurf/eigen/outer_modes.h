// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// The eigenvectors that vanish on the ring, continued to the whole grid: those of S12, the columns
/// of W1 in Lacewell & Burley 2007, section 3.1.
///
/// S12 does not depend on the valence and is diagonalisable. Its eigenvalues are 1/8 and 1/16, each
/// twice, 1/32 once for each side of the face that lies inside the sector, and 1/64.
template <typename Real>
class OuterModes {
 public:
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using SlotValues = std::array<Real, tile_grid::kSlots>;

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

  /// The outer part y of a vector whose ring part is x: (S12 - lambda) y = -S11 x + rhs (Lacewell &
  /// Burley 2007, section 3.1).
  ///
  /// The components of the right-hand side along the outer modes with eigenvalue `met` are not
  /// solved for but returned in `rest`: a step takes (x, y) to lambda (x, y) + rhs + W1 rest. Where
  /// lambda equals an eigenvalue of S12, `met` has to be that eigenvalue; y has no component along
  /// its modes then, and `rest` is 0 except at interior valence 2.
  Vector continuation(Real lambda, Real met, const SlotValues& ring_values, const Vector& rhs,
                      Vector& rest) const;
  /// S11 x.
  Vector fromRing(const SlotValues& ring_values) const;

 private:
  Sides sides_;
  TileStep<Real> step_;
  std::vector<int> slots_;
  std::vector<Real> lambda_;
  Matrix s11_, s12_, vectors_, inverse_;
};

extern template class OuterModes<double>;
extern template class OuterModes<long double>;

}  // namespace limitsurf
