// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// A rectangle of a patch's parameters: (s, t) to (s + s_size, t + t_size).
struct ParameterRectangle {
  double s, t, s_size, t_size;
};

}  // namespace limitsurf
