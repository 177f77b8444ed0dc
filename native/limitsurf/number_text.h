// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace limitsurf {

/// The number as somebody would write it: with the fewest digits that tell it from all others. NaN
/// has no sign.
template <typename Real>
std::string numberText(Real value) {
  if (std::isnan(value)) {
    return "nan";
  }
  using Limits = std::numeric_limits<Real>;
  std::string written;
  for (int digits = Limits::digits10; digits <= Limits::max_digits10; ++digits) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(digits);
    stream << value;
    written = stream.str();
    Real read = 0;
    std::istringstream back(written);
    back.imbue(std::locale::classic());
    if (back >> read && read == value) {
      break;
    }
  }
  return written;
}

}  // namespace limitsurf
