// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/patches/core_tangents.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/surface/patches/core_step.h"

namespace limitsurf {
namespace {

using Matrix = Eigen::MatrixXd;

/// Eigenvalues that differ by no more than this count as equal.
constexpr double kSameEigenvalue = 1e-12;
/// More than the rounding of a bound.
constexpr double kMargin = 1 + 1e-9;
/// The differences of the Bezier points of one patch along s or along t.
constexpr int kDifferences = 12;

/// The two modes with the largest eigenvalue below 1, if there are exactly two and a step does
/// nothing to them but shrink them.
bool findLargest(const Eigenbasis& basis, int modes[2]) {
  int count = 0;
  double largest = 0;
  for (int mode = 1; mode < basis.modeCount(); ++mode) {
    largest = std::max(largest, basis.eigenvalue(mode));
  }
  for (int mode = 1; mode < basis.modeCount(); ++mode) {
    if (basis.eigenvalue(mode) > largest - kSameEigenvalue) {
      if (count == 2) {
        return false;
      }
      modes[count++] = mode;
    }
  }
  if (count != 2) {
    return false;
  }
  const auto isLargest = [&](int mode) { return mode == modes[0] || mode == modes[1]; };
  for (const Eigenbasis::Chain& chain : basis.chains()) {
    if (isLargest(chain.from) || isLargest(chain.to)) {
      return false;
    }
  }
  for (const ModePair& pair : basis.pairs()) {
    if (isLargest(pair.a) || isLargest(pair.b)) {
      return false;
    }
  }
  return true;
}

/// Calls visit(i, low, high) for the differences of neighbours among Bezier points: first those
/// along s, then those along t.
template <typename Visit>
void forEachDifference(const Visit& visit) {
  for (int i = 0; i < kDifferences; ++i) {
    const int along_s = 4 * (i / 3) + i % 3, along_t = 4 * (i % 3) + i / 3;
    visit(i, along_s, along_s + 1);
    visit(kDifferences + i, along_t, along_t + 4);
  }
}

/// The differences of the three patches that a step leaves: a row of weights of the core's points
/// for each, and the two modes at them.
struct Differences {
  Differences(const Eigenbasis& basis, int face, const CoreStep& step, const int modes[2])
      : weights(3 * 2 * kDifferences, step.matrix.rows()), factors(weights.rows(), 2) {
    const Sides sides = basis.sides(face);
    for (int quarter = 1; quarter < 4; ++quarter) {
      const int a = quarter % 2, b = quarter / 2, first = (quarter - 1) * 2 * kDifferences;
      CoreStep::Weights window[16];
      step.window(a, b, sides, window);
      convertBothWays(window, toBezier<CoreStep::Weights>);
      forEachDifference(
          [&](int i, int low, int high) { weights.row(first + i) = window[high] - window[low]; });
      for (int k = 0; k < 2; ++k) {
        const Eigenbasis::Table table = basis.table(modes[k], face);
        double values[16];
        for (int i = 0; i < 16; ++i) {
          values[i] = table.grid[(b + i / 4) * tile_grid::kSize + a + i % 4];
        }
        continueSides(values, onRight(sides) && a == 0, false, onLeft(sides) && b == 0, false);
        convertBothWays(values, toBezier<double>);
        forEachDifference(
            [&](int i, int low, int high) { factors(first + i, k) = values[high] - values[low]; });
      }
    }
  }

  /// The least Jacobian determinant of any difference along s with any along t of the same patch.
  /// Determinants on the patch are means of them.
  double leastArea() const {
    double least = std::numeric_limits<double>::infinity();
    for (int first = 0; first < factors.rows(); first += 2 * kDifferences) {
      for (int i = 0; i < kDifferences; ++i) {
        for (int j = 0; j < kDifferences; ++j) {
          const auto s = factors.row(first + i), t = factors.row(first + kDifferences + j);
          least = std::min(least, s[0] * t[1] - s[1] * t[0]);
        }
      }
    }
    return least;
  }

  Matrix weights, factors;
};

}  // namespace

CoreTangents::CoreTangents(const Eigenbasis& basis, int face) {
  int modes[2];
  if (!findLargest(basis, modes)) {
    return;
  }
  const CoreStep step(basis, face);
  Differences differences(basis, face, step, modes);
  least_area_ = differences.leastArea();
  if (!(least_area_ > 0)) {
    return;
  }
  longest_ = kMargin * differences.factors.rowwise().norm().maxCoeff();
  const Eigen::Index size = step.matrix.rows(), ring = basis.ring().size();
  size_ = static_cast<std::size_t>(size);
  Matrix unit = Matrix::Zero(basis.modeCount(), 3);
  unit(modes[0], 0) = unit(modes[1], 1) = unit(0, 2) = 1;
  const Matrix dual = basis.projectTransposed(unit);
  weights_.assign(size_, Eigen::Array2d::Zero());
  modes_ = weights_;
  for (int k = 0; k < 2; ++k) {
    const std::vector<double> on_ring = basis.ringVector(modes[k]);
    const Eigenbasis::Table table = basis.table(modes[k], face);
    for (std::size_t i = 0; i < size_; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      weights_[i][k] = row < ring ? dual(row, k) : 0;
      modes_[i][k] = row < ring ? on_ring[i] : table.outer[row - ring];
    }
  }
  // What the two modes and the constant one, which is there by rounding alone, leave over.
  Matrix rest = differences.weights;
  const auto leaveOutConstant = [&] {
    rest.leftCols(ring) -= rest.rowwise().sum() * dual.col(2).transpose();
  };
  rest.leftCols(ring) -= differences.factors * dual.leftCols<2>().transpose();
  leaveOutConstant();
  const double largest = basis.eigenvalue(modes[0]);
  const Matrix shrinking = step.matrix / largest;
  std::vector<Eigen::ArrayXd> bounds;
  for (int n = 1; n <= SurfacePatches::kMostSteps; ++n) {
    bounds.push_back(kMargin * rest.cwiseAbs().colwise().maxCoeff().transpose().array());
    rest = rest * shrinking;
    leaveOutConstant();
  }
  for (std::size_t n = bounds.size() - 1; n > 0; --n) {
    bounds[n - 1] = bounds[n - 1].max(bounds[n]);
  }
  for (int n = 0; n < kSteps; ++n) {
    others_.insert(others_.end(), bounds[static_cast<std::size_t>(n)].begin(),
                   bounds[static_cast<std::size_t>(n)].end());
  }
}

bool CoreTangents::settle(const Padded points[], Settling& out) const {
  if (size_ == 0) {
    return false;
  }
  Vector3 first = Vector3::Zero(), second = Vector3::Zero();
  for (std::size_t i = 0; i < size_; ++i) {
    const Vector3 point = points[i].head<3>();
    first += weights_[i][0] * point;
    second += weights_[i][1] * point;
  }
  const Vector3 across = first.cross(second);
  const double area = across.norm();
  if (!(area > 0)) {
    return false;
  }
  out.tangents_ = this;
  out.normal_ = across / area;
  out.area_ = area;
  out.longest_ = longest_ * std::sqrt(first.squaredNorm() + second.squaredNorm());
  for (std::size_t i = 0; i < size_; ++i) {
    const Vector3 rest =
        points[i].head<3>().matrix() - modes_[i][0] * first - modes_[i][1] * second;
    const double off = rest.dot(out.normal_);
    out.off_[i] = std::abs(off);
    out.within_[i] = (rest - off * out.normal_).norm();
  }
  return true;
}

double CoreTangents::Settling::slopeAfter(int steps) const {
  if (steps >= kSteps) {
    return std::numeric_limits<double>::infinity();
  }
  const std::size_t size = tangents_->size_;
  const double* weights = &tangents_->others_[static_cast<std::size_t>(steps) * size];
  double off = 0, within = 0;
  for (std::size_t i = 0; i < size; ++i) {
    off += weights[i] * off_[i];
    within += weights[i] * within_[i];
  }
  // With s and t for the parts of two tangents within the plane, and a and b for those off it,
  // their cross product rises by s x t along the axis, and has s x b + a x t across.
  const double rise = tangents_->least_area_ * area_ - within * (2 * longest_ + within);
  const double aside = 2 * off * (longest_ + within);
  return rise > 0 ? aside / rise : std::numeric_limits<double>::infinity();
}

}  // namespace limitsurf
