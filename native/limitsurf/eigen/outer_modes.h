// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// The eigenvectors that vanish on the ring: those of S12 (paper: W1), continued to the whole grid.
///
/// S12 does not depend on the valence and has no defect. Its eigenvalues are 1/8 and 1/16 twice,
/// 1/32 once for each side of the face that lies inside the sector, and 1/64.
template <typename Real>
class OuterModes {
 public:
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Cells = std::array<Real, tile_grid::kCells>;

  explicit OuterModes(Sides sides);

  /// The same modes, rounded.
  template <typename Wider>
  explicit OuterModes(const OuterModes<Wider>& other)
      : sides_(other.sides()),
        step_(sides_),
        cells_(other.cells()),
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
  /// The grid cells of the outer points, count() of them.
  const std::vector<int>& cells() const { return cells_; }
  Real lambda(int q) const { return lambda_[q]; }
  const Matrix& vectors() const { return vectors_; }  ///< W: one column per mode
  const Matrix& inverse() const { return inverse_; }  ///< W^-1
  const Matrix& s11() const { return s11_; }          ///< outer from ring cells (columns by cell)
  const Matrix& s12() const { return s12_; }
  const TileStep<Real>& step() const { return step_; }

  /// The outer part y of a vector whose ring part is x: (S12 - lambda) y = -S11 x + rhs (paper,
  /// section 3.1).
  ///
  /// The right-hand side's share of the modes with eigenvalue `met` is not solved for but goes to
  /// `rest`, in the basis W: a step takes (x, y) to lambda (x, y) + rhs + W rest. Where lambda
  /// equals an eigenvalue of S12, `met` has to: y is the minimal solution then, and the rest is 0
  /// but for interior valence 2.
  Vector continuation(Real lambda, Real met, const Cells& ring_cells, const Vector& rhs,
                      Vector& rest) const;
  /// S11 x.
  Vector fromRing(const Cells& ring_cells) const;

 private:
  Sides sides_;
  TileStep<Real> step_;
  std::vector<int> cells_;
  std::vector<Real> lambda_;
  Matrix s11_, s12_, vectors_, inverse_;
};

extern template class OuterModes<double>;
extern template class OuterModes<long double>;

}  // namespace limitsurf
