// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/surface/tiled_surface.h"

namespace limitsurf {

struct SurfaceData::Data {
  static constexpr Eigen::Index kColumnsPerPose = 3;

  /// `vertex_rows`: for each vertex of the tiles' mesh, the row of its value; empty if vertices and
  /// rows have the same numbers.
  Data(std::shared_ptr<const TiledSurface> surface, std::vector<int> vertex_rows,
       const DataRows& values, int threads);

  void set(const DataRows& values, int threads);

  std::shared_ptr<const TiledSurface> tiles;
  std::vector<int> rows_of_vertices;
  Eigen::Index rows, columns;
  bool is_set = false;
  std::vector<Pose> poses;  // one for every three columns
};

}  // namespace limitsurf
