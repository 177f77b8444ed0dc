// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kScatterSetupTable[] = "scatter-setup";
constexpr char kUniformTable[] = "uniform";
constexpr char kBlueNoiseTable[] = "blue-noise";

/// `count` points on whole meshes: uniform beside points on the triangles of a level-4
/// tessellation, blue noise beside what a sieve leaves of eight times as many uniform points.
std::vector<Group> scatterGroups(int count);

}  // namespace limitsurf::bench
