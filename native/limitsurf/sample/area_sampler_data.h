// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/area_cells.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

struct AreaSampler::Data {
  Data(const LimitSurface& limit_surface, int threads)
      : surface(limit_surface),
        patches(limit_surface, threads),
        cells(areaCells(patches, threads)),
        plain(patches, cells, DensityField(), threads) {}

  /// More than rounding errors.
  bool hasArea() const { return plain.total() > 1e-14 * patches.diagonal() * patches.diagonal(); }
  /// Whether each Ptex face has a surface, with area or not.
  std::vector<bool> hasSurface() const;

  const LimitSurface& surface;
  SurfacePatches patches;
  std::vector<AreaCell> cells;
  CellTable plain;
};

}  // namespace limitsurf
