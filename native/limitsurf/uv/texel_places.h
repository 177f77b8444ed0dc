// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// Where derivatives have no limit or surface or map are singular, they are taken so much of the
/// way to the face's centre.
constexpr double kStepAside = 0x1p-10;

/// The location so much of the way to its face's centre.
Location steppedAside(const Location& at);

/// A surface at the centres of texels of its map, and by how much things move from texel to texel
/// along x and along y. Steps are 0 where the map is singular.
struct TexelPlaces {
  Points position;
  Points normal;  ///< frames()'s where evaluate() has none
  Points along_x, along_y;
  Points normal_along_x, normal_along_y;  ///< no rows unless asked for
  Footprints parameters;                  ///< du/dx, du/dy, dv/dx, dv/dy
};

/// `texel`: its size in the map's units.
TexelPlaces texelPlaces(const LimitSurface& surface, const SurfaceData& map, Span<Location> at,
                        const Eigen::Vector2d& texel, bool normal_steps, int threads);

/// Throws std::invalid_argument for a size that is not finite and above 0.
void checkTexel(const Eigen::Vector2d& texel);

/// With vectors longer than kLongestFootprint shortened to that; 0 for what is not finite.
Eigen::Matrix2d shortened(const Eigen::Matrix2d& footprint);

/// Whether the columns are finite and do not lie on a line, as far as rounding can tell.
bool isRegular(const Eigen::Matrix2d& jacobian);

}  // namespace limitsurf
