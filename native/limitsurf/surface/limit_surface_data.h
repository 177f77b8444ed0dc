// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/parallel.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/pose.h"
#include "limitsurf/surface/tile_evaluator.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

struct LimitSurface::Data {
  explicit Data(ControlMesh control_mesh);

  /// Throws LocationError or MeshError for the first row that cannot be evaluated.
  void check(Span<Location> at, int threads) const;

  /// Calls body(row, place among the tiles, evaluator) for each row, in parallel.
  template <typename Body>
  void forEach(Span<Location> at, int threads, const Body& body) const {
    constexpr std::size_t kGrain = 512;
    parallelFor(at.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
      TileEvaluator evaluator(table, pose);
      for (std::size_t row = begin; row < end; ++row) {
        body(static_cast<Eigen::Index>(row), evaluator.locate(at[row]), evaluator);
      }
    });
  }

  const Ring& ringAt(const TileLocation& at) const {
    return table.rings[table.ring_tiles[at.tile.index].ring].basis->ring();
  }
  VertexApproach approachTo(const TileLocation& at) const;

  ControlMesh mesh;
  Points positions;
  PtexFaces ptex;
  std::map<int, std::string> refused;
  TileTable table;
  Pose pose;

 private:
  // The topology is only needed to build the tiles, and gone afterwards.
  Data(ControlMesh&& control_mesh, PtexFaces&& ptex_faces, const Topology& topology);
};

}  // namespace limitsurf
