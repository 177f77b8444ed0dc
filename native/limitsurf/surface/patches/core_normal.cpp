// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/patches/core_normal.h"

#include <cmath>

#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/surface/bezier_conversion.h"

namespace limitsurf {
namespace {

using Matrix = Eigen::MatrixXd;
/// The weights of a core's control points in one point.
using Weights = Eigen::RowVectorXd;

/// After 2^6 steps the rest of a core has less than 1e-20 of its area.
constexpr int kDoublings = 6;
/// Rounding errors, as parts of the products that are added up.
constexpr double kRounding = 1e-15;

/// A subdivision step of a core's control points, which are those of the ring and the outer ones.
struct CoreStep {
  CoreStep(const Eigenbasis& basis, int face) {
    const OuterModes<double>& outer = basis.outerModes(face);
    const std::vector<int>& slots = outer.slots();
    const Eigen::Index ring = basis.ring().size(),
                       size = ring + static_cast<Eigen::Index>(slots.size());
    const Matrix unit = Matrix::Identity(size, size);
    matrix = Matrix::Zero(size, size);
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

  Matrix matrix;
  std::vector<Weights> grid;  ///< the control grid after the step
};

/// The integrals over [0, 1] of the derivative of cubic B-spline i times B-spline j.
Eigen::Matrix4d splineProducts() {
  Eigen::Matrix4d products;
  products << -10, -71, -38, -1, -9, -150, -183, -18, 18, 183, 150, 9, 1, 38, 71, 10;
  return products / 720;
}

/// The form of the integral of ds x dt on a patch: the factors of p_a x p_b.
Eigen::Matrix<double, 16, 16> patchForm() {
  const Eigen::Matrix4d products = splineProducts();
  Eigen::Matrix<double, 16, 16> form;
  for (int a = 0; a < 16; ++a) {
    for (int b = 0; b < 16; ++b) {
      form(a, b) = products(a % 4, b % 4) * products(b / 4, a / 4);
    }
  }
  return form;
}

/// The form of the three patches that a step leaves.
Matrix ringOfPatches(const CoreStep& step, Sides sides) {
  const Eigen::Matrix<double, 16, 16> form = patchForm();
  Matrix sum = Matrix::Zero(step.matrix.rows(), step.matrix.rows());
  for (int quarter = 1; quarter < 4; ++quarter) {
    const int a = quarter % 2, b = quarter / 2;
    Weights window[16];
    for (int i = 0; i < 16; ++i) {
      window[i] = step.grid[(b + i / 4) * tile_grid::kSize + a + i % 4];
    }
    continueSides(window, onRight(sides) && a == 0, false, onLeft(sides) && b == 0, false);
    Matrix weights(16, step.matrix.rows());
    for (int i = 0; i < 16; ++i) {
      weights.row(i) = window[i];
    }
    sum += weights.transpose() * form * weights;
  }
  return sum;
}

}  // namespace

CoreNormal::CoreNormal(const Eigenbasis& basis, int face) {
  const CoreStep step(basis, face);
  Matrix form = ringOfPatches(step, basis.sides(face)), power = step.matrix;
  for (int doubling = 0; doubling < kDoublings; ++doubling) {
    form += power.transpose() * form * power;
    power = power * power;
  }
  size_ = static_cast<std::size_t>(form.rows());
  factors_.reserve(size_ * (size_ - 1) / 2);
  for (Eigen::Index i = 0; i < form.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < form.rows(); ++j) {
      factors_.push_back(form(i, j) - form(j, i));
      sum_ += std::abs(factors_.back());
    }
  }
}

CoreNormal::Value CoreNormal::value(const Padded points[]) const {
  Value result = {Vector3::Zero(), 0};
  Padded largest = Padded::Zero();
  const double* factor = factors_.data();
  for (std::size_t i = 0; i < size_; ++i) {
    Padded sum = Padded::Zero();
    for (std::size_t j = i + 1; j < size_; ++j) {
      sum += *factor++ * points[j];
    }
    const Padded& p = points[i];
    result.normal += Vector3(p[1] * sum[2] - p[2] * sum[1], p[2] * sum[0] - p[0] * sum[2],
                             p[0] * sum[1] - p[1] * sum[0]);
    largest = largest.max(p.abs());
  }
  result.rounding =
      kRounding * 2 * sum_ *
      Vector3(largest[1] * largest[2], largest[2] * largest[0], largest[0] * largest[1]).norm();
  return result;
}

}  // namespace limitsurf
