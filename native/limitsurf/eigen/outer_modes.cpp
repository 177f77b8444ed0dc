// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/outer_modes.h"

#include <Eigen/LU>
#include <algorithm>

namespace limitsurf {
namespace {

/// Pivots below this fraction of the largest one count as 0 when the rank of S12 - lambda is
/// determined. The entries are multiples of 1/64 of size 1 at most in matrices of at most 7 rows,
/// so that a pivot is 0 up to rounding (1e-16) or larger than this by orders.
constexpr double kRankThreshold = 1e-9;

/// The denominators of the distinct eigenvalues of S12, and how often each occurs.
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
  for (const int c : tile_grid::kOuterSlots) {
    if (tile_grid::exists(sides, c)) {
      slots_.push_back(c);
    }
  }
  const int n = static_cast<int>(slots_.size());
  s11_ = Matrix::Zero(n, tile_grid::kSlots);
  s12_ = Matrix::Zero(n, n);
  for (const auto& row : step_.rows()) {
    const auto target = std::find(slots_.begin(), slots_.end(), row.slot);
    if (target == slots_.end()) {
      continue;
    }
    for (std::size_t i = row.first; i < row.end; ++i) {
      const auto& term = step_.term(i);
      const auto source = std::find(slots_.begin(), slots_.end(), term.slot);
      if (source == slots_.end()) {
        s11_(target - slots_.begin(), term.slot) = term.weight;
      } else {
        s12_(target - slots_.begin(), source - slots_.begin()) = term.weight;
      }
    }
  }

  vectors_ = Matrix::Zero(n, n);
  for (const auto& [denominator, multiplicity] : spectrum(sides)) {
    const Real lambda = Real(1) / denominator;
    Eigen::FullPivLU<Matrix> lu(s12_ - lambda * Matrix::Identity(n, n));
    lu.setThreshold(kRankThreshold);
    const Matrix kernel = lu.kernel();
    eigen_assert(kernel.cols() == multiplicity);
    for (int i = 0; i < multiplicity; ++i) {
      vectors_.col(static_cast<int>(lambda_.size())) = kernel.col(i);
      lambda_.push_back(lambda);
    }
  }
  inverse_ = vectors_.fullPivLu().inverse();
}

template class OuterModes<double>;
template class OuterModes<DoubleDouble>;

}  // namespace limitsurf
