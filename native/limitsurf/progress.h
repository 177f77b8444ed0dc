// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace limitsurf {

/// Told now and then, on the calling thread, which part of the work is done, 0 to 1. What it throws
/// ends the work.
using Progress = std::function<void(double part)>;

}  // namespace limitsurf
