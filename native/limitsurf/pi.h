// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

template <typename Real>
constexpr Real kPi = static_cast<Real>(3.14159265358979323846264338327950288L);

}  // namespace limitsurf
