// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kFixedTable[] = "fixed";

/// Benchmarks of about `sample_count` locations that stay while a mesh gets the positions of one
/// frame after the other.
std::vector<Group> fixedGroups(int sample_count);

}  // namespace limitsurf::bench
