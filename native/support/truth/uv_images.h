// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/uv/uv_map.h"
#include "support/cages/meshes.h"
#include "support/truth/uv_witness.h"

namespace limitsurf::test {

RasterOptions image(int width, int height, double margin = 0);

/// The centre of a texel, on the map.
Eigen::RowVector2d centre(const RasterOptions& options, int x, int y);
/// The centres of all texels, row by row.
DataRows centres(const RasterOptions& options);

/// The values of the map at the locations of texels.
DataRows valuesAt(const SurfaceData& map, const Texels& texels);

/// The row of `texels` of each pixel, y * width + x; -1 if there is none.
std::vector<int> rowsOf(const Texels& texels, const RasterOptions& options);

bool sameBits(const Texels& a, const Texels& b);

/// A map on columns x rows squares with one value for each vertex, which `place` chooses.
template <typename Place>
NamedMap gridMap(int columns, int rows, Interpolation interpolation, const Place& place) {
  const Cage cage = grid(columns, rows);
  DataRows values(cage.vertexCount(), 2);
  for (int v = 0; v < cage.vertexCount(); ++v) {
    values.row(v) = place(cage.positions(v, 0) / columns, cage.positions(v, 1) / rows);
  }
  std::vector<std::int64_t> corners;
  for (const auto& face : cage.faces) corners.insert(corners.end(), face.begin(), face.end());
  LimitSurface surface = limitSurface(cage);
  SurfaceData map = surface.faceVarying(values, corners, interpolation);
  return {"grid", std::move(surface), std::move(map)};
}

}  // namespace limitsurf::test
