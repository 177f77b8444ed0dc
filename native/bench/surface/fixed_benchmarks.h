// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kFixedTable[] = "fixed";

/// Benchmarks of locations that stay while a mesh gets the positions of one frame after the other:
/// one and ten on each Ptex face.
std::vector<Group> fixedGroups();

}  // namespace limitsurf::bench
