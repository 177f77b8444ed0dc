// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/scatter_along.h"

namespace limitsurf {

/// Places along curves.
struct AlongPlaces {
  std::vector<int> curve;
  std::vector<double> arc;
};

/// Throws std::invalid_argument for options that are out of range or contradict each other.
void checkAlongOptions(const AlongOptions& options);

/// The number of locations on each curve.
std::vector<std::int64_t> alongCounts(const EdgeCurves& curves, const AlongOptions& options);

/// Places with so many on each curve. Each `row` has random numbers of its own.
AlongPlaces alongPlaces(const EdgeCurves& curves, const std::vector<std::int64_t>& counts,
                        const AlongOptions& options, int row);

}  // namespace limitsurf
