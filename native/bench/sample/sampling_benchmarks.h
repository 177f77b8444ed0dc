// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kSamplerSetupTable[] = "scatter-setup";
constexpr char kUniformTable[] = "uniform";
constexpr char kBlueNoiseTable[] = "blue-noise";

/// Benchmarks of `count` points on whole meshes: uniform points beside points on the triangles of a
/// level-4 tessellation, and blue noise beside the points that a sieve leaves of eight times as
/// many uniform points.
std::vector<Group> samplingGroups(int count);

}  // namespace limitsurf::bench
