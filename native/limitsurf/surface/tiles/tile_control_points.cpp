// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/tile_control_points.h"

#include <Eigen/Core>
#include <utility>

#include "limitsurf/patch/single_crease.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/tile_weights.h"

namespace limitsurf {
namespace {

/// Row i: the weights of a regular tile's four points along one axis in B-spline control point i.
using AxisMatrix = Eigen::Matrix4d;

/// Points beyond a boundary are the linear continuation of the two next to it (paper, figure 2).
AxisMatrix continued(bool low, bool high) {
  AxisMatrix m = AxisMatrix::Identity();
  if (low) {
    m.row(0) << 0, 2, -1, 0;
  }
  if (high) {
    m.row(3) << 0, -1, 2, 0;
  }
  return m;
}

/// The B-spline control points of the cubic on [near, far] across a crease, from its derivatives at
/// `near`: each is the cubic's blossom at three neighbouring knots.
AxisMatrix acrossStrip(float sharpness, bool cut, double near, double far) {
  const SingleCrease crease(sharpness);
  const double h = far - near;
  const CubicWeights at = crease.weights(near, cut), mid = crease.weights(near + h / 2, cut);
  const auto secondOnPoints = [](const CubicWeights& w) -> Eigen::RowVector4d {
    return {w.second[0], w.second[1] - 2 * w.second[0], w.second[0] - 2 * w.second[1], w.second[1]};
  };
  double first[4];
  at.firstOnPoints(first);
  const Eigen::RowVector4d value = Eigen::Map<const Eigen::RowVector4d>(at.value);
  const Eigen::RowVector4d slope = h * Eigen::Map<const Eigen::RowVector4d>(first);
  const Eigen::RowVector4d bend = h * h / 2 * secondOnPoints(at);
  const Eigen::RowVector4d cubic = h * h / 3 * (secondOnPoints(mid) - secondOnPoints(at));
  AxisMatrix m;
  for (int i = 0; i < 4; ++i) {
    const double p = i - 2, q = i - 1, r = i;  // in widths of the strip
    m.row(i) =
        value + (p + q + r) / 3 * slope + (p * q + q * r + r * p) / 3 * bend + p * q * r * cubic;
  }
  return m;
}

}  // namespace

CageRow onCage(const RefinedPoints& points, PointWeights<double>& weights) {
  weights.moveToVertices(points);
  CageRow row;
  row.indices.reserve(weights.entries().size());
  row.weights.reserve(weights.entries().size());
  for (const auto& [point, weight] : weights.entries()) {
    if (weight != 0) {
      row.indices.push_back(point);
      row.weights.push_back(weight);
    }
  }
  return row;
}

void ControlPoints::turn(int turns) {
  ControlPoint turned[16];
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      // The tile is [0, 1]^2 and its control points lie at whole numbers from -1 to 2.
      double u = x - 1, v = y - 1;
      turnParameters(turns, u, v);
      const int from = 4 * (static_cast<int>(v) + 1) + static_cast<int>(u) + 1;
      turned[4 * y + x] = std::move(points[from]);
    }
  }
  std::move(turned, turned + 16, points);
}

ControlPoints TileBuilder::operator()(const TilePart& part) const {
  ControlPoints control;
  if (part.tile.kind == TileRef::kRing) {
    buildQuarter(part, control);
  } else {
    buildStrip(part, control);
  }
  control.turn(part.turns);
  return control;
}

void TileBuilder::buildStrip(const TilePart& part, ControlPoints& control) const {
  const BSplineTile& tile = table_.bsplines[part.tile.index];
  AxisMatrix x = continued(tile.x_low, tile.x_high), y = continued(tile.y_low, tile.y_high);
  if (tile.crease > 0) {
    const TileStrips::Strip strip = TileStrips(tile).at(part.strip);
    switch (tile.crease_side) {
      case 0:
        y = acrossStrip(tile.crease, tile.y_high, strip.v0, strip.v1);
        break;
      case 1:
        x = acrossStrip(tile.crease, tile.x_low, 1 - strip.u1, 1 - strip.u0).reverse().eval();
        break;
      case 2:
        y = acrossStrip(tile.crease, tile.y_low, 1 - strip.v1, 1 - strip.v0).reverse().eval();
        break;
      default:
        x = acrossStrip(tile.crease, tile.x_high, strip.u0, strip.u1);
    }
  }
  const int anchor = tile.points[5];
  control.anchor.point = anchor;
  control.relative = tile.fine;
  PointWeights<double> weights(0);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      ControlPoint& out = control.points[4 * j + i];
      if (!tile.fine && x.row(i) == AxisMatrix::Identity().row(i) &&
          y.row(j) == AxisMatrix::Identity().row(j)) {
        out.point = tile.points[4 * j + i];
        continue;
      }
      weights.clear();
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) {
          if (const double w = y(j, k) * x(i, l); w != 0) {
            weights.add(tile.points[4 * k + l], w);
          }
        }
      }
      if (tile.fine) {
        weights.add(anchor, -1);
      }
      out.row = onCage(table_.points, weights);
    }
  }
}

void TileBuilder::buildQuarter(const TilePart& part, ControlPoints& control) const {
  const RingTile& tile = table_.ring_tiles[part.tile.index];
  const RingPoints& ring = table_.rings[tile.ring];
  const Eigenbasis& basis = *ring.basis;
  const AxisMatrix x = continued(onRight(tile.sides) && part.a == 0, false);
  const AxisMatrix y = continued(onLeft(tile.sides) && part.b == 0, false);
  Eigen::MatrixXd on_modes(basis.modeCount(), 17), on_outer, mode_weights, outer_weights;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      GridWindow window{part.a, part.b, CubicWeights(0, false, false),
                        CubicWeights(0, false, false), 0};
      Eigen::Map<Eigen::RowVector4d>(window.u.value) = x.row(i);
      Eigen::Map<Eigen::RowVector4d>(window.v.value) = y.row(j);
      basis.weights(tile.face, part.steps, tile.ring_steps, window, mode_weights, outer_weights);
      on_outer.conservativeResize(outer_weights.cols(), 16);
      on_modes.col(4 * j + i) = mode_weights.row(0).transpose();
      on_outer.col(4 * j + i) = outer_weights.row(0).transpose();
      // Relative to the limit: without the constant mode, but for what balances the outer points.
      on_modes(0, 4 * j + i) = -outer_weights.row(0).sum();
    }
  }
  on_modes.col(16).setZero();
  on_modes(0, 16) = 1;  // the limit itself
  const Eigen::MatrixXd on_ring = basis.projectTransposed(on_modes);
  PointWeights<double> weights(0);
  const auto rowOf = [&](Eigen::Index column) {
    weights.clear();
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      weights.add(ring.points[i], on_ring(static_cast<Eigen::Index>(i), column));
    }
    for (Eigen::Index i = 0; column < 16 && i < on_outer.rows(); ++i) {
      weights.add(tile.outer[static_cast<std::size_t>(i)], on_outer(i, column));
    }
    return onCage(table_.points, weights);
  };
  for (int i = 0; i < 16; ++i) {
    control.points[i].row = rowOf(i);
  }
  control.anchor.row = rowOf(16);
  control.relative = true;
}

}  // namespace limitsurf
