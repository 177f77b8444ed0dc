// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/area_cells.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/cell_table.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// What an AreaSampler keeps: the surface's patches, in their own unit, cut into cells.
struct AreaSampler::Data {
  Data(const LimitSurface& limit_surface, int threads)
      : surface(limit_surface),
        patches(limit_surface, threads, PatchUnit::own),
        cells(areaCells(patches, threads)),
        uniform(cells) {}

  /// An area of this part of the diagonal's square and less is nothing but rounding errors.
  static constexpr double kNoArea = 1e-14;
  bool hasArea() const {
    return uniform.total() > kNoArea * patches.diagonal() * patches.diagonal();
  }
  /// For each Ptex face whether it has a surface, with area or without.
  std::vector<bool> hasSurface() const;

  /// Throws std::invalid_argument if there are limits, but not those of this surface's faces or all
  /// of them 0, and naming a limit that is negative or not finite.
  void checkLimits(const DensityLimits& limits, const std::vector<bool>& has_surface) const;

  /// AreaSampler::uniform() for a density function.
  std::vector<Location> ofFunction(std::size_t count, std::uint64_t seed, const Density& density,
                                   int threads, const Progress& progress) const;

  const LimitSurface& surface;
  SurfacePatches patches;
  std::vector<AreaCell> cells;
  CellTable uniform;  ///< for a density that is the same everywhere
};

}  // namespace limitsurf
