// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace limitsurf {

/// A function that is called from time to time, on the calling thread, with the part of the work
/// that is done, 0 to 1. If it throws, the work ends.
using Progress = std::function<void(double part)>;

}  // namespace limitsurf
