// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/bilinear_tiles.h"

#include "limitsurf/interruption_point.h"
#include "limitsurf/mesh/topology.h"

namespace limitsurf {
namespace {

/// Corners in the order of (u, v) = (0,0), (1,0), (1,1), (0,1).
BSplineTile bilinear(const std::array<int, 4>& corners) {
  BSplineTile tile;
  tile.x_low = tile.x_high = tile.y_low = tile.y_high = true;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const bool right = x >= 2, top = y >= 2;
      tile.points[4 * y + x] = corners[top ? (right ? 2 : 3) : (right ? 1 : 0)];
    }
  }
  return tile;
}

}  // namespace

TileTable buildBilinearTiles(const ControlMesh& mesh, const Topology& topology,
                             const PtexFaces& ptex) {
  TileTable table{RefinedPoints(mesh.vertexCount(), mesh.options()), {}, {}, {}, {}, {}};
  table.faces.assign(ptex.base_face.size(), TileRef{TileRef::kNone, 0});
  std::vector<int> midpoints(static_cast<std::size_t>(topology.level().GetNumEdges()), -1);
  const auto midpoint = [&](int face, int side, int a, int b) {
    int& point = midpoints[topology.level().GetFaceEdges(face)[side]];
    if (point < 0) {
      point = table.points.addMidpoint(a, b);
    }
    return point;
  };
  const auto add = [&](int ptex_face, const std::array<int, 4>& corners) {
    table.faces[ptex_face] = {TileRef::kBSpline, static_cast<std::uint32_t>(table.bsplines.size())};
    table.bsplines.push_back(bilinear(corners));
  };
  InterruptionStride stride;
  for (int face = 0; face < mesh.faceCount(); ++face) {
    stride.step();
    if (topology.refused().count(face)) {
      continue;
    }
    const Span<int> v = mesh.faceVertices(face);
    const int size = static_cast<int>(v.size());
    if (size == 4) {
      add(ptex.first[face], {v[0], v[1], v[2], v[3]});
      continue;
    }
    const int centre = table.points.addFacePoint(std::vector<int>(v.begin(), v.end()));
    for (int c = 0; c < size; ++c) {
      const int before = (c + size - 1) % size;
      add(ptex.first[face] + c, {v[c], midpoint(face, c, v[c], v[(c + 1) % size]), centre,
                                 midpoint(face, before, v[before], v[c])});
    }
  }
  return table;
}

}  // namespace limitsurf
