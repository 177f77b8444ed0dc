// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// The numbers of the rows in the order of a Z-order curve (Morton) through their bounding box, so
/// that successive searches look at the same parts of the surface. Few rows stay as they are. All
/// coordinates must be finite.
std::vector<std::size_t> spatialOrder(const Eigen::Ref<const Points>& points, int threads);

}  // namespace limitsurf
