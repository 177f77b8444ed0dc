// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/precision/double_double.h"

namespace Eigen {

/// What Eigen has to know to take double-doubles as the elements of a matrix.
template <>
struct NumTraits<limitsurf::DoubleDouble> : GenericNumTraits<limitsurf::DoubleDouble> {
  using Number = limitsurf::DoubleDouble;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 25
  };

  static Number epsilon() { return 0x1p-105; }
  static Number dummy_precision() { return 1e-28; }
  static Number highest() { return NumTraits<double>::highest(); }
  static Number lowest() { return NumTraits<double>::lowest(); }
  static int digits10() { return 31; }
};

}  // namespace Eigen
