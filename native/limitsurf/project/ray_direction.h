// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// The direction of rays from a surface: along its normals, against them, or both.
enum class RayDirection { both, outward, inward };

}  // namespace limitsurf
