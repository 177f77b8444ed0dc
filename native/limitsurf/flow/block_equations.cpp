// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/flow/block_equations.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <complex>

namespace limitsurf {
namespace {

/// Blocks count as turning ones up to this part of their size, which is more than rounding.
constexpr double kRounding = 1e-12;

}  // namespace

void BlockEquations::add(int row, int column, const Eigen::Matrix2d& values) {
  const Eigen::Vector2d mirroring(values(0, 0) - values(1, 1), values(0, 1) + values(1, 0));
  are_complex_ = are_complex_ && mirroring.norm() <= kRounding * values.norm();
  blocks_.push_back({row, column, values});
}

std::optional<Eigen::VectorXd> BlockEquations::solve(const Eigen::VectorXd& right) const {
  return are_complex_ ? solved<std::complex<double>>(right) : solved<double>(right);
}

template <typename Number>
std::optional<Eigen::VectorXd> BlockEquations::solved(const Eigen::VectorXd& right) const {
  constexpr bool kIsComplex = Eigen::NumTraits<Number>::IsComplex;
  constexpr int kUnknowns = kIsComplex ? 1 : 2;
  std::vector<Eigen::Triplet<Number>> entries;
  entries.reserve(blocks_.size() * kUnknowns * kUnknowns);
  for (const Block& block : blocks_) {
    if constexpr (kIsComplex) {
      entries.emplace_back(block.row, block.column, Number(block.values(0, 0), block.values(1, 0)));
    } else {
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          entries.emplace_back(2 * block.row + i, 2 * block.column + j, block.values(i, j));
        }
      }
    }
  }
  const Eigen::Index size = kUnknowns * Eigen::Index{vertex_count_};
  Eigen::SparseMatrix<Number> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Number>> solver(matrix);
  if (solver.info() != Eigen::Success) {
    return std::nullopt;
  }
  // A complex number lies in memory as its two parts do.
  using Numbers = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
  const Eigen::Map<const Numbers> given(reinterpret_cast<const Number*>(right.data()), size);
  const Numbers found = solver.solve(given);
  return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
      reinterpret_cast<const double*>(found.data()), right.size()));
}

}  // namespace limitsurf
