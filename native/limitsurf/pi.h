// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

template <typename Real>
constexpr Real kPi = static_cast<Real>(3.141592653589793);

}  // namespace limitsurf
