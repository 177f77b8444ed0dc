// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/point_weights.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/tiles/tile_place.h"

namespace limitsurf {

/// Weights on the cage's vertices in the order of their numbers, without zeros.
struct CageRow {
  std::vector<int> indices;
  std::vector<double> weights;
};

/// Moves weights on refined points to the vertices, and leaves out those that are 0.
CageRow onCage(const RefinedPoints& points, PointWeights<double>& weights);

/// A point of a tile: one of the table's points, or a row of its own.
struct ControlPoint {
  int point = -1;  ///< where it is one of the table's
  CageRow row;     ///< where not
};

/// One tile's control points, in the tile's own frame first, then along the Ptex face's axes.
struct ControlPoints {
  ControlPoint points[16];
  ControlPoint anchor;
  bool relative = false;  ///< rows add up to 0, and the base is the point without weights

  void turn(int turns);
};

/// Makes the control points of parts of tiles.
class TileBuilder {
 public:
  explicit TileBuilder(const TileTable& table) : table_(table) {}

  ControlPoints operator()(const TilePart& part) const;

 private:
  void buildStrip(const TilePart& part, ControlPoints& control) const;
  /// The quarter's window of the ring tile's control grid, relative to the limit at the vertex.
  void buildQuarter(const TilePart& part, ControlPoints& control) const;

  const TileTable& table_;
};

}  // namespace limitsurf
