// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/outer_modes.h"

#include <Eigen/LU>
#include <algorithm>

namespace limitsurf {
namespace {

/// The distinct eigenvalues of S12 and how often each occurs.
std::vector<std::pair<int, int>> spectrum(Sides sides) {
  const int inner_sides = sides == Sides::inner ? 2 : sides == Sides::both ? 0 : 1;
  std::vector<std::pair<int, int>> result = {{8, 2}, {16, 2}, {64, 1}};
  if (inner_sides > 0) {
    result.push_back({32, inner_sides});
  }
  return result;
}

}  // namespace

template <typename Real>
OuterModes<Real>::OuterModes(Sides sides) : sides_(sides), step_(sides) {
  for (const int c : tile_grid::kOuterCells) {
    if (tile_grid::exists(sides, c)) {
      cells_.push_back(c);
    }
  }
  const int n = static_cast<int>(cells_.size());
  s11_ = Matrix::Zero(n, tile_grid::kCells);
  s12_ = Matrix::Zero(n, n);
  for (const auto& row : step_.rows()) {
    const auto target = std::find(cells_.begin(), cells_.end(), row.cell);
    if (target == cells_.end()) {
      continue;
    }
    for (std::size_t i = row.first; i < row.end; ++i) {
      const auto& term = step_.term(i);
      const auto source = std::find(cells_.begin(), cells_.end(), term.cell);
      if (source == cells_.end()) {
        s11_(target - cells_.begin(), term.cell) = term.weight;
      } else {
        s12_(target - cells_.begin(), source - cells_.begin()) = term.weight;
      }
    }
  }

  vectors_ = Matrix::Zero(n, n);
  for (const auto& [denominator, multiplicity] : spectrum(sides)) {
    const Real lambda = Real(1) / denominator;
    Eigen::FullPivLU<Matrix> lu(s12_ - lambda * Matrix::Identity(n, n));
    lu.setThreshold(Real(1e-9));  // entries are dyadic rationals above 1/64 in size
    const Matrix kernel = lu.kernel();
    eigen_assert(kernel.cols() == multiplicity);
    for (int i = 0; i < multiplicity; ++i) {
      vectors_.col(static_cast<int>(lambda_.size())) = kernel.col(i);
      lambda_.push_back(lambda);
    }
  }
  inverse_ = vectors_.fullPivLu().inverse();
}

template <typename Real>
typename OuterModes<Real>::Vector OuterModes<Real>::continuation(Real lambda, Real met,
                                                                 const Cells& ring_cells,
                                                                 const Vector& rhs,
                                                                 Vector& rest) const {
  const Vector right = inverse_ * (rhs - fromRing(ring_cells));
  Vector z = Vector::Zero(count());
  rest = Vector::Zero(count());
  for (int q = 0; q < count(); ++q) {
    if (lambda_[q] == met) {
      rest[q] = -right[q];
    } else {
      z[q] = right[q] / (lambda_[q] - lambda);
    }
  }
  return vectors_ * z;
}

template <typename Real>
typename OuterModes<Real>::Vector OuterModes<Real>::fromRing(const Cells& ring_cells) const {
  return s11_ * Eigen::Map<const Vector>(ring_cells.data(), tile_grid::kCells);
}

template class OuterModes<double>;
template class OuterModes<long double>;

}  // namespace limitsurf
