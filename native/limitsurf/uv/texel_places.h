// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// Where derivatives have no limit, or the surface or the map is singular, derivatives are taken
/// this part of the way towards the face's centre.
constexpr double kStepAside = 0x1p-10;

/// The location moved by kStepAside of the way towards its face's centre.
Location steppedAside(const Location& at);

/// A surface at the centres of the texels of its map, and the steps from texel to texel along x and
/// along y. Steps are 0 where the map is singular.
struct TexelPlaces {
  Points position;
  Points normal;                          ///< of evaluate(), or of frames() where that has none
  Points along_x, along_y;                ///< steps of the position
  Points normal_along_x, normal_along_y;  ///< steps of the normal; no rows unless asked for
  Footprints parameters;                  ///< du/dx, du/dy, dv/dx, dv/dy
};

/// `texel` is the size of a texel in units of the map. Steps of the normal are computed only with
/// `normal_steps`.
TexelPlaces texelPlaces(const LimitSurface& surface, const SurfaceData& map,
                        const LocationBatch& at, const Eigen::Vector2d& texel, bool normal_steps,
                        int threads);

/// Throws std::invalid_argument for a size that is not finite and above 0.
void checkTexel(const Eigen::Vector2d& texel);

/// The footprint with its vectors shortened to kLongestFootprint; 0 if it is not finite.
Eigen::Matrix2d shortened(const Eigen::Matrix2d& footprint);

/// Whether the columns are finite and linearly independent, in spite of rounding.
bool isRegular(const Eigen::Matrix2d& jacobian);

}  // namespace limitsurf
