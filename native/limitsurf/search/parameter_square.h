// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// A square of a patch's parameters.
struct ParameterSquare {
  double s, t, size;
};

}  // namespace limitsurf
