// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/direction_maps.h"

#include <Eigen/LU>
#include <limits>

namespace limitsurf {

MatrixInOwnUnit::MatrixInOwnUnit(const Eigen::Matrix3d& given, const Exponents3x3& exponents)
    : matrix(given), unit(0) {
  int largest = std::numeric_limits<int>::min();
  for (int i = 0; i < 9; ++i) {
    const double size = std::abs(given(i));
    if (size > 0 && std::isfinite(size)) {
      largest = std::max(largest, std::ilogb(size) + exponents(i));
    }
  }
  unit = largest == std::numeric_limits<int>::min() ? 0 : -largest;
  for (int i = 0; i < 9; ++i) {
    matrix(i) = std::ldexp(given(i), exponents(i) + unit);
  }
}

Exponents3 columnExponents(const Eigen::Matrix3d& matrix) {
  Exponents3 exponents;
  for (int column = 0; column < 3; ++column) {
    exponents[column] = exponentOf(matrix.col(column).cwiseAbs().maxCoeff());
  }
  return exponents;
}

Eigen::Matrix3d withColumnsTimes(const Eigen::Matrix3d& matrix, const Exponents3& exponents) {
  Eigen::Matrix3d result;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      result(row, column) = std::ldexp(matrix(row, column), exponents[column]);
    }
  }
  return result;
}

// The map is rows * core * columns, with diagonal matrices of powers of two. Powers of two change
// no digit of any sum of products of which all have the same ones: the determinant and the inverse
// of the core have the digits of those of the map.
DirectionMaps::DirectionMaps(const Eigen::Matrix3d& linear)
    : vectors(MatrixInOwnUnit(linear, Exponents3x3::Zero()).matrix) {
  const Exponents3 columns = columnExponents(linear);
  Eigen::Matrix3d core = withColumnsTimes(linear, -columns);
  const Exponents3 rows = columnExponents(core.transpose());
  core = withColumnsTimes(core.transpose(), -rows).transpose().eval();
  side = core.determinant() < 0 ? -1 : 1;
  Exponents3x3 exponents;
  for (int column = 0; column < 3; ++column) {
    exponents.col(column) = -rows - columns[column];
  }
  normals = MatrixInOwnUnit(core.inverse(), exponents.transpose()).matrix.transpose();
}

}  // namespace limitsurf
