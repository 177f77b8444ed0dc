// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose.h"

namespace limitsurf {

/// The tile of a location, and where in the tile it lies.
struct TileLocation {
  TileRef tile;
  double u, v;  ///< in the tile's frame; that of a ring tile is turned so that its vertex is (0, 0)
  int turns;    ///< by how many corners that frame is turned against the Ptex face's, 0 to 3
  int depth;    ///< how many splits of the Ptex face lead to the tile

  /// Whether the location is the extraordinary vertex of a ring tile.
  bool atVertex() const { return tile.kind == TileRef::kRing && u == 0 && v == 0; }
};

/// Evaluates single locations. It keeps the control points of a regular tile that two locations in
/// a row lie on, as they do in batches sorted by face. Each thread needs an evaluator of its own.
class TileEvaluator {
 public:
  TileEvaluator(const TileTable& table, const Pose& pose) : table_(table), pose_(pose) {}

  TileLocation locate(const Location& at) const;

  /// At an extraordinary vertex derivatives without a limit are NaN.
  template <int Order>
  void evaluate(const TileLocation& at, Jet& jet);

  /// The unit normal where the jet was evaluated; NaN where du x dv vanishes. Must not be called at
  /// an extraordinary vertex.
  ///
  /// Deep in a ring tile the leading mode may make du and dv so close to parallel that their cross
  /// product loses all its digits. There the products of different modes are added up instead.
  Vector3 normalDirection(const TileLocation& at, const Jet& jet);

 private:
  /// Up to so many steps du x dv itself keeps kNormalError: the angle between du and dv is about
  /// 2^-steps at least, so that their product loses 8 bits at most.
  static constexpr int kStepsToParallel = 8;
  /// Products of all pairs of modes take time that grows with the square of their number. With more
  /// modes than this, du x dv is taken.
  static constexpr int kMostPairedModes = 256;

  template <int Order>
  void evaluateBSpline(const TileLocation& at, Jet& jet);
  template <int Order>
  void evaluateBSpline(const TileLocation& at, const CubicWeights& u, const CubicWeights& v,
                       Jet& jet);
  template <int Order>
  void evaluateRing(const TileLocation& at, Jet& jet);
  /// Evaluates by Eigenbasis::weights(), for second derivatives deep in a ring tile.
  void evaluateByModes(const RingTile& tile, int index, int steps, const GridWindow& window,
                       PatchValues<Padded>& patch);
  const TileTable& table_;
  const Pose& pose_;
  int last_ = -1, loaded_ = -1;  // the last regular tile, and the one whose points are kept
  Padded window_[16];            // the points of the latter, relative to its anchor
  Eigen::MatrixXd mode_weights_, outer_weights_;
};

}  // namespace limitsurf
