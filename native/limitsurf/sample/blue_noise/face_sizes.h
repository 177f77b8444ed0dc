// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// For each face that has a surface its largest extent along u or v, times `scale`, roughly; -1 for
/// others.
std::vector<double> faceSizes(const LimitSurface& surface, const std::vector<bool>& has_surface,
                              double scale, int threads);

}  // namespace limitsurf
