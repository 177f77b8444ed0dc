// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kStrandTable[] = "strands";

/// Benchmarks of posing `count` strands of 8 points, beside evaluating their roots with first
/// derivatives.
std::vector<Group> strandGroups(int count);

}  // namespace limitsurf::bench
