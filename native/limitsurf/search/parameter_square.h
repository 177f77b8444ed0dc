// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// A square of a patch's parameters: (s, t) to (s + size, t + size).
struct ParameterSquare {
  double s, t, size;
};

}  // namespace limitsurf
