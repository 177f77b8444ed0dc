// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// What the topology of a control mesh alone decides: which faces have a surface, and of which
/// tiles. A surface and the data on it share it.
struct TiledSurface {
  TiledSurface(const ControlMesh& mesh, const Topology& topology);
  explicit TiledSurface(const ControlMesh& mesh) : TiledSurface(mesh, Topology(mesh)) {}

  /// Throws LocationError or MeshError for the first row that cannot be evaluated,
  /// std::invalid_argument for a number of threads that has no meaning.
  void check(Span<Location> at, int threads) const;

  PtexFaces ptex;
  std::map<int, std::string> refused;  ///< faces of the control mesh without a surface -> reason
  TileTable table;
};

}  // namespace limitsurf
