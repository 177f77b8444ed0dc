// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace limitsurf {

/// A number that depends on the bits of so many points alone and is never 0. If one of the bits
/// changes, so does the number, but for one case in 2^32.
std::int32_t fingerprint(const float* points, std::size_t count);

}  // namespace limitsurf
