// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose.h"

namespace limitsurf {

/// Where a location lies among the tiles.
struct TileLocation {
  TileRef tile;
  double u, v;  ///< in the tile's frame; of a ring tile turned so that its vertex is (0, 0)
  int turns;    ///< corners by which that frame is turned against the Ptex face's, 0 to 3
  int depth;    ///< splits on the way to the tile

  /// At the extraordinary vertex of a ring tile.
  bool atVertex() const { return tile.kind == TileRef::kRing && u == 0 && v == 0; }
};

/// Weights of a regular tile's points at (u, v), along each axis.
struct TileWeights {
  TileWeights(const BSplineTile& tile, double u, double v);
  CubicWeights u, v;
};

/// The rectangles of a regular tile in which it is one bicubic patch: all of it, or strips along a
/// crease.
struct TileStrips {
  explicit TileStrips(const BSplineTile& tile);

  struct Strip {
    double u0, u1, v0, v1;
  };
  Strip at(int i) const;

  int count;

 private:
  int side_;
  double borders_[4];  // distances from the crease
};

/// Evaluates single locations. Keeps the control points of a regular tile that is asked for twice
/// in a row, as batches sorted by face do; one evaluator belongs to one thread.
class TileEvaluator {
 public:
  TileEvaluator(const TileTable& table, const Pose& pose) : table_(table), pose_(pose) {}

  TileLocation locate(const Location& at) const;

  /// At an extraordinary vertex derivatives without a limit are NaN.
  template <int Order>
  void evaluate(const TileLocation& at, Jet& jet);

  /// The unit normal where the jet was evaluated, NaN where du x dv vanishes. Not to be asked at an
  /// extraordinary vertex.
  ///
  /// Deep in a ring tile the leading mode may bring du and dv so close to parallel that nothing is
  /// left of their product; there the products of different modes are added up instead.
  Vector3 normalDirection(const TileLocation& at, const Jet& jet);

 private:
  /// Up to here du x dv itself keeps kNormalError: du and dv differ by 2^-steps at least.
  static constexpr int kStepsToParallel = 8;
  /// Pairs of modes cost their number squared.
  static constexpr int kMostPairedModes = 256;

  template <int Order>
  void evaluateBSpline(const TileLocation& at, Jet& jet);
  template <int Order>
  void evaluateBSpline(const TileLocation& at, const CubicWeights& u, const CubicWeights& v,
                       Jet& jet);
  template <int Order>
  void evaluateRing(const TileLocation& at, Jet& jet);
  /// Each mode's derivatives on their own, for second derivatives deep in a ring tile.
  void evaluateByModes(const RingTile& tile, int index, int steps, const GridWindow& window,
                       PatchValues<Padded>& patch);
  const TileTable& table_;
  const Pose& pose_;
  int last_ = -1, loaded_ = -1;  // regular tiles
  Padded window_[16];            // of the loaded one, relative to its anchor
  Eigen::MatrixXd mode_weights_, outer_weights_;
};

/// The quarter of a ring tile that (u, v) lies in after enough subdivisions to leave the vertex's
/// own quarter behind, and where in it. Not to be asked at the vertex.
struct Quarter {
  Quarter(double u, double v);
  int steps;    ///< >= 1
  int a, b;     ///< 0 or 1, not both 0
  double u, v;  ///< in [0, 1]
};

/// The window on a ring tile's grid that serves the quarter, for derivatives up to `order`.
GridWindow gridWindow(const Quarter& quarter, Sides sides, int order);

}  // namespace limitsurf
