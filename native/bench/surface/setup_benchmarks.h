// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kOpeningTable[] = "open";
constexpr char kPosingTable[] = "pose";

/// Benchmarks of opening and posing whole meshes, each of which has regular faces and those of one
/// irregular class.
std::vector<Group> setupGroups();

}  // namespace limitsurf::bench
