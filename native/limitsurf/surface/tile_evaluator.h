// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/curvature/mode_products.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose/pose.h"

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

  TileLocation locate(const Location& at) const {
    return locateBelow({table_.faces[at.face], at.u, at.v, 0, 0});
  }
  /// The same for a location whose tile may split further.
  TileLocation locateBelow(TileLocation at) const;

  /// At an extraordinary vertex derivatives without a limit are NaN.
  template <int Order>
  void evaluate(const TileLocation& at, Jet& jet);
  void evaluateUpTo(int order, const TileLocation& at, Jet& jet) {
    order == 0 ? evaluate<0>(at, jet) : order == 1 ? evaluate<1>(at, jet) : evaluate<2>(at, jet);
  }

  /// The unit normal where the jet was evaluated; NaN where its condition number exceeds
  /// kMostNormalCondition. Must not be called at an extraordinary vertex.
  ///
  /// Deep in a ring tile the leading mode may make du and dv so close to parallel that their cross
  /// product loses all its digits. Where the squared sine of their angle is below kLowestSineSquare
  /// the products of different modes are added up instead.
  Vector3 normalDirection(const TileLocation& at, const Jet& jet);
  /// Whether normalDirection() is just du x dv, because the jet meets normalLimits().
  bool hasPlainNormal(const TileLocation& at, const Jet& jet) const;
  /// Where du and dv meet these limits, normalDirection() is their product. For locations that lie
  /// in a quarter of a ring tile after so many steps, or in a regular tile (0), and whose tile is
  /// so many splits below the face.
  NormalLimits normalLimits(int steps, int depth) const;
  NormalLimits normalLimits(const TileLocation& at) const;
  /// The same for control points of this size.
  static NormalLimits normalLimits(const PointsSize& points, int steps, int depth);

  /// The forms, for curvature, where the jet was evaluated, with second derivatives.
  ///
  /// Deep in a ring tile the second derivatives lie almost in the tangent plane. There their parts
  /// along the normal are added up from products of three modes each.
  FundamentalForms fundamentalForms(const TileLocation& at, const Jet& jet);
  /// Whether the location lies so deep.
  static bool needsModeProducts(const TileLocation& at);

  /// Whether derivatives up to `order`, deep in a tile of this ring, are formed of the differences
  /// of each of its modes (derivative_nets.h) instead of those of the control points that the modes
  /// add up to.
  ///
  /// Second derivatives are, because modes of very different size meet in them. So are first ones
  /// around a cone or a tip: the mode with the largest eigenvalue has, by symmetry, no derivative
  /// across the spokes, and its rounding would hide that of the others.
  static bool needsNets(const Eigenbasis& basis, int order) {
    const RingKind kind = basis.ring().kind;
    return order == 2 || (order == 1 && (kind == RingKind::cone || kind == RingKind::tip));
  }

  /// Whether such derivatives at (u, v) of the tile are added up mode by mode instead: on the
  /// spokes, where by symmetry some derivatives of the largest modes vanish, but not the
  /// differences of which they are formed.
  static bool takesModes(const Eigenbasis& basis, int order, double u, double v) {
    return (u == 0 || v == 0) && needsNets(basis, order);
  }

 private:
  /// Up to so many steps products of the sums themselves are taken. Between du and dv the angle is
  /// then about 2^-steps at least, so that du x dv loses 8 bits at most. Second derivatives are
  /// about 2^steps times their part along the normal at most, which loses as many.
  static constexpr int kStepsToParallel = 8;
  /// Below those steps du x dv is taken at angles of this size, which cost it 8 bits as well.
  static constexpr double kLowestSineSquare = 0x1p-16;

  /// What the rounding of du and dv is relative to, unless needsModeProducts(): the size of the
  /// tile's control points.
  double sizeOf(const TileLocation& at) const;
  /// The modes of a ring tile and its outer points, with their weights at a location: first
  /// derivatives, for order 2 second ones as well.
  void gatherModes(const TileLocation& at, int order, ModeProducts& products);

  template <int Order>
  void evaluateBSpline(const TileLocation& at, Jet& jet);
  template <int Order>
  void evaluateBSpline(const TileLocation& at, const CubicWeights& u, const CubicWeights& v,
                       Jet& jet);
  template <int Order>
  void evaluateRing(const TileLocation& at, Jet& jet);
  /// Evaluates by Eigenbasis::weights(), where takesModes().
  void evaluateByModes(const RingTile& tile, int index, int steps, const GridWindow& window,
                       PatchValues<Padded>& patch);

  const TileTable& table_;
  const Pose& pose_;
  int last_ = -1, loaded_ = -1;  // the last regular tile, and the one whose points are kept
  Padded window_[16];            // the points of the latter, relative to its anchor
  Eigen::MatrixXd mode_weights_, outer_weights_;
  Pose::OwnGrids own_grids_;
};

}  // namespace limitsurf
