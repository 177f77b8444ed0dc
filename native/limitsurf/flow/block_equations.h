// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace limitsurf {

/// A symmetric positive definite system of equations with two unknowns for each vertex, as a sum of
/// blocks of 2 x 2 numbers.
class BlockEquations {
 public:
  explicit BlockEquations(int vertex_count) : vertex_count_(vertex_count) {}

  void reserve(std::size_t blocks) { blocks_.reserve(blocks); }
  /// Adds a block in the rows of one vertex and the columns of another one. The caller also adds
  /// its transpose, with row and column exchanged.
  void add(int row, int column, const Eigen::Matrix2d& values);

  /// The unknowns, two numbers for each vertex, as `right` has them. Sparse factorization: that of
  /// complex numbers, in a third of the time, if all blocks turn and stretch vectors, but none
  /// mirrors them. Nothing if the system is not positive definite.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& right) const;

 private:
  struct Block {
    int row, column;
    Eigen::Matrix2d values;
  };
  /// With the unknowns of a vertex as two numbers, or as one complex number.
  template <typename Number>
  std::optional<Eigen::VectorXd> solved(const Eigen::VectorXd& right) const;

  int vertex_count_;
  std::vector<Block> blocks_;
  bool are_complex_ = true;  // all blocks multiply vectors as complex numbers do
};

}  // namespace limitsurf
