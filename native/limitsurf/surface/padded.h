// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limitsurf {

/// A point or vector, padded to four doubles so that it fills whole registers.
using Padded = Eigen::Array4d;

/// The numbers of points, as the kernels read them.
inline const double (*numbersOf(const Padded* points))[4] {
  static_assert(sizeof(Padded) == 4 * sizeof(double));
  return reinterpret_cast<const double (*)[4]>(points);
}

}  // namespace limitsurf
