// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kOpeningTable[] = "open";
constexpr char kPosingTable[] = "pose";

/// Whole meshes, each of faces of one class and regular ones.
std::vector<Group> setupGroups();

}  // namespace limitsurf::bench
