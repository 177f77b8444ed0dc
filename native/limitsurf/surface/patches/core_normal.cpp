// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/patches/core_normal.h"

#include <cmath>

#include "limitsurf/surface/bezier_conversion.h"
#include "limitsurf/surface/patches/core_step.h"

namespace limitsurf {
namespace {

using Matrix = Eigen::MatrixXd;

/// After 2^6 steps the rest of a core has less than 1e-20 of its area.
constexpr int kDoublings = 6;
/// Rounding errors, as parts of the products that are added up.
constexpr double kRounding = 1e-15;

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
    CoreStep::Weights window[16];
    step.window(a, b, sides, window);
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
