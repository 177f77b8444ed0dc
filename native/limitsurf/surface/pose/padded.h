// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limitsurf {

/// A point or vector, padded to four doubles so that it fills whole registers.
using Padded = Eigen::Array4d;

static_assert(sizeof(Padded) == 4 * sizeof(double), "points are rows of numbers");

/// The numbers of points, as the kernels read and write them.
inline const double (*numbersOf(const Padded* points))[4] {
  return reinterpret_cast<const double (*)[4]>(points);
}
inline double (*numbersOf(Padded* points))[4] { return reinterpret_cast<double (*)[4]>(points); }

}  // namespace limitsurf
