// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "limitsurf/own_unit.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Powers of two, by their exponents.
using Exponents3 = Eigen::Array3i;
using Exponents3x3 = Eigen::Array33i;

/// The matrix whose entries are those of `matrix` times 2^exponents, times the power of two that
/// leaves the largest of them between 1 and 2, which is 2^unit. Entries that are 2^1022 times
/// smaller than that may vanish.
struct MatrixInOwnUnit {
  MatrixInOwnUnit(const Eigen::Matrix3d& matrix, const Exponents3x3& exponents);

  Eigen::Matrix3d matrix;
  int unit;
};

/// The exponents of the largest entry of each column; 0 where that is 0 or not finite.
Exponents3 columnExponents(const Eigen::Matrix3d& matrix);

/// The matrix with column j multiplied by 2^exponents[j].
Eigen::Matrix3d withColumnsTimes(const Eigen::Matrix3d& matrix, const Exponents3& exponents);

/// The matrices by which a linear map carries vectors and normals, each times a power of two that
/// leaves its largest entry between 1 and 2. So the determinant and the inverse of a map, which are
/// made of products of three lengths, exist for every unit of length. Axes of a map may differ by a
/// factor of 2^1000.
struct DirectionMaps {
  explicit DirectionMaps(const Eigen::Matrix3d& linear);

  Eigen::Matrix3d vectors;
  Eigen::Matrix3d normals;  ///< the transposed inverse; not finite if the map is singular
  double side;              ///< -1 if the map mirrors, else 1
};

/// v over its length, also where the square of that overflows or underflows.
inline Vector3 safelyNormalized(const Vector3& v) {
  const double square = v.squaredNorm();
  if (square >= 0x1p-900 && square <= 0x1p900) {
    return v / std::sqrt(square);
  }
  return (scaleToOwnUnit(v.cwiseAbs().maxCoeff()) * v).normalized();
}

}  // namespace limitsurf
