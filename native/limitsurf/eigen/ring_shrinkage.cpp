// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/ring_shrinkage.h"

#include <algorithm>

namespace limitsurf {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// More than the rounding of all sums here.
constexpr double kMargin = 1 + 1e-9;

/// S times a matrix.
Matrix subdivided(const Eigenbasis& basis, const Matrix& points) {
  Matrix next(points.rows(), points.cols());
  basis.step().apply([&](int i) { return points.row(i); }, [&](int i) { return next.row(i); });
  return next;
}

}  // namespace

std::vector<double> ringShrinkage(const Eigenbasis& basis, int steps) {
  const Eigen::Index size = basis.ring().size();
  const Eigen::RowVectorXd limit =
      basis.projectTransposed(Eigen::MatrixXd::Identity(size, 1)).transpose();
  Matrix power = Matrix::Identity(size, size);
  power.rowwise() -= limit;
  std::vector<double> bounds = {1};
  for (int step = 1; step <= steps; ++step) {
    power = subdivided(basis, power);
    bounds.push_back(
        std::min(kMargin * power.cwiseAbs().rowwise().sum().maxCoeff(), bounds.back()));
  }
  return bounds;
}

}  // namespace limitsurf
