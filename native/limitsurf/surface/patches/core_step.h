// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/surface/bezier_conversion.h"

namespace limitsurf {

/// A subdivision step of a core's control points, which are those of the ring and the outer ones.
struct CoreStep {
  /// The weights of a core's control points in one point.
  using Weights = Eigen::RowVectorXd;

  CoreStep(const Eigenbasis& basis, int face) {
    const OuterModes<double>& outer = basis.outerModes(face);
    const std::vector<int>& slots = outer.slots();
    const Eigen::Index ring = basis.ring().size(),
                       size = ring + static_cast<Eigen::Index>(slots.size());
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(size, size);
    matrix = Eigen::MatrixXd::Zero(size, size);
    basis.step().apply([&](int i) { return unit.row(i); }, [&](int i) { return matrix.row(i); });
    std::vector<Weights> before(tile_grid::kSlots, Weights::Zero(size));
    grid = before;
    forEachRingSlot(basis.ring(), face, [&](int slot, int point) {
      before[slot] = unit.row(point);
      grid[slot] = matrix.row(point);
    });
    for (std::size_t i = 0; i < slots.size(); ++i) {
      before[slots[i]] = unit.row(ring + static_cast<Eigen::Index>(i));
    }
    outer.step().apply(before, grid);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      matrix.row(ring + static_cast<Eigen::Index>(i)) = grid[slots[i]];
    }
  }

  /// The B-spline control points of one of the patches that the step leaves: of the quarter (a, b).
  void window(int a, int b, Sides sides, Weights out[16]) const {
    for (int i = 0; i < 16; ++i) {
      out[i] = grid[(b + i / 4) * tile_grid::kSize + a + i % 4];
    }
    continueSides(out, onRight(sides) && a == 0, false, onLeft(sides) && b == 0, false);
  }

  Eigen::MatrixXd matrix;
  std::vector<Weights> grid;  ///< the control grid after the step
};

}  // namespace limitsurf
