// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tile_evaluator.h"
#include "limitsurf/surface/tiled_surface.h"
#include "limitsurf/surface/vertex_approach.h"

namespace limitsurf {

struct LimitSurface::Data {
  explicit Data(ControlMesh control_mesh);

  void check(const LocationBatch& at, int threads) const { tiles->check(at, threads); }

  /// Calls body(row, tile location, evaluator) for each row, in parallel.
  template <typename Body>
  void forEach(const LocationBatch& at, int threads, const Body& body) const {
    parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
      TileEvaluator evaluator(table, pose);
      for (std::size_t row = begin; row < end; ++row) {
        body(static_cast<Eigen::Index>(row), evaluator.locate(at[row]), evaluator);
      }
    });
  }

  VertexApproach approachTo(const TileLocation& at) const;

  ControlMesh mesh;
  Points positions;
  std::shared_ptr<const TiledSurface> tiles;
  const PtexFaces& ptex;
  const std::map<int, std::string>& refused;
  const TileTable& table;
  Pose pose;
};

}  // namespace limitsurf
