// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/mesh/ptex_faces.h"
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

class Topology;

/// A quad on which the surface is one bicubic B-spline patch, or a few bicubic strips along a
/// crease.
struct BSplineTile {
  std::array<int, 16> points;  ///< row-major in (y, x), from (-1, -1) to (2, 2)
  /// Sides with no points beyond them: boundaries of the surface and infinitely sharp edges. Their
  /// entries in `points` repeat others and weigh nothing.
  bool x_low, x_high, y_low, y_high;
  /// Sharpness of the one semi-sharp side (see SingleCrease), or 0; and which side that is: from
  /// corner `crease_side` to the next.
  float crease = 0;
  std::int8_t crease_side = 0;
  /// Whether the quad is so small that the rounding of its points matters (see TileTable::fine).
  bool fine = false;

  bool hasEnds() const { return x_low | x_high | y_low | y_high; }
};

/// A quad with an extraordinary vertex at one corner and regular ones at the others.
struct RingTile {
  int ring;        ///< index into TileTable::rings
  int face;        ///< which of the ring's faces
  int ring_steps;  ///< by how many subdivisions the ring's points are older than the outer points
  int corner;      ///< the quad's corner with the extraordinary vertex
  int depth;       ///< how many splits of the Ptex face led to the quad
  Sides sides;     ///< of the ring's face
  /// Whether the sides across from the vertex, seen from it at u = 1 and v = 1, have no points
  /// beyond them; their entries in `outer` continue the surface linearly.
  bool u_high, v_high;
  std::array<int, tile_grid::kOuter> outer;  ///< points, in the order of the basis's outer slots
};

/// An extraordinary vertex: its eigenbasis and its points, shared by all tiles around it.
struct RingPoints {
  std::shared_ptr<const Eigenbasis> basis;
  std::vector<int> points;  ///< in the order of Ring
};

/// The tile of a Ptex face or of one of the four children of a split quad, or its split.
struct TileRef {
  enum Kind : std::uint32_t { kNone = 0, kBSpline = 1, kRing = 2, kSplit = 3 };
  std::uint32_t kind : 2;
  std::uint32_t index : 30;
};

/// The surface as a list of tiles. It depends on the topology alone and knows no positions.
///
/// A Ptex face is one tile, or splits into four children, child c standing at its corner c with the
/// orientation of RefinedMesh; children are tiles or split again. Quads
/// are split where one tile does not suffice: beside faces other than quads, where a quad has
/// several extraordinary vertices, and where sharpness has not decayed yet.
struct TileTable {
  RefinedPoints points;
  std::vector<TileRef> faces;  ///< per Ptex face
  std::vector<std::array<TileRef, 4>> splits;
  std::vector<BSplineTile> bsplines;
  std::vector<RingTile> ring_tiles;  ///< grouped by ring
  std::vector<RingPoints> rings;

  /// From this depth on a point that is rounded to double is too inexact for second derivatives,
  /// which multiply its rounding by 4^depth: tables with such tiles need points of twice the
  /// precision. At smaller depths that factor is 16 at most.
  static constexpr int kFineDepth = 3;
  bool fine = false;

  /// Whether all points of the tile are vertices of the control mesh.
  bool isOnVertices(const BSplineTile& tile) const {
    return std::all_of(tile.points.begin(), tile.points.end(),
                       [this](int point) { return point < points.cagePoints(); });
  }

  /// The deepest split. Sharpness decays within 10 steps, and one or two more separate the
  /// extraordinary vertices of a quad; the rest is room to spare.
  static constexpr int kMostDepth = 14;
};

/// Faces that `topology` refuses get tiles of kind kNone.
TileTable buildTileTable(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex);

}  // namespace limitsurf
