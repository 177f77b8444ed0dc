// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// What depends on the topology of a control mesh alone: which faces have a surface, and the tiles
/// of these. A surface and the data on it share it.
struct TiledSurface {
  TiledSurface(const ControlMesh& mesh, const Topology& topology);
  explicit TiledSurface(const ControlMesh& mesh) : TiledSurface(mesh, Topology(mesh)) {}

  /// Throws LocationError or MeshError for the first row that cannot be evaluated, unless the batch
  /// has been checked here before.
  LocationBatch checked(const LocationBatch& at, int threads) const;
  /// The same, and throws std::invalid_argument for a negative number of threads.
  void check(const LocationBatch& at, int threads) const;
  /// The same for one row.
  void check(const LocationBatch& at, std::size_t row) const;

  PtexFaces ptex;
  std::map<int, std::string> refused;  ///< faces of the control mesh without a surface -> reason
  TileTable table;
};

}  // namespace limitsurf
