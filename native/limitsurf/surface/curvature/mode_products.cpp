// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/curvature/mode_products.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

/// Determinant of the rows (p0, p1) and (q0, q1).
double minor(double p0, double p1, double q0, double q1) { return p0 * q1 - p1 * q0; }

}  // namespace

void ModeProducts::add(const Eigen::Ref<const Eigen::VectorXd>& weights, const Vector3& vector) {
  Mode mode{vector, {}, 0};
  for (int d = 0; d < count_; ++d) {
    mode.weights[d] = weights[1 + d];
  }
  modes_.push_back(mode);
}

void ModeProducts::sort() {
  double first = 0, second = 0, length = 0;
  for (const Mode& mode : modes_) {
    length = std::max(length, mode.vector.cwiseAbs().maxCoeff());
    for (int d = 0; d < count_; ++d) {
      double& largest = d < 2 ? first : second;
      largest = std::max(largest, std::abs(mode.weights[d]));
    }
  }
  first_ = first > 0 ? first : 1;
  second_ = second > 0 ? second : 1;
  length_ = length > 0 ? length : 1;
  for (Mode& mode : modes_) {
    mode.vector /= length_;
    double largest = 0;
    for (int d = 0; d < count_; ++d) {
      mode.weights[d] /= d < 2 ? first_ : second_;
      largest = std::max(largest, std::abs(mode.weights[d]));
    }
    mode.size = largest * mode.vector.norm();
  }
  const auto larger = [](const Mode& a, const Mode& b) { return a.size > b.size; };
  const auto apart =
      modes_.begin() + std::min<std::ptrdiff_t>(kApart, modes_.end() - modes_.begin());
  std::nth_element(modes_.begin(), apart, modes_.end(), larger);
  for (int d = 0; d < count_; ++d) {
    rest_[d].setZero();
    for (auto mode = apart; mode != modes_.end(); ++mode) {
      rest_[d] += mode->weights[d] * mode->vector;
    }
  }
  for (auto mode = apart; mode != modes_.end(); ++mode) {
    rest_weights_[0] += std::abs(mode->weights[0]);
    rest_weights_[1] += std::abs(mode->weights[1]);
  }
  modes_.erase(apart, modes_.end());
}

Vector3 ModeProducts::sum(int derivative) const {
  Vector3 result = rest_[derivative];
  for (const Mode& mode : modes_) {
    result += mode.weights[derivative] * mode.vector;
  }
  return result;
}

Vector3 ModeProducts::cross() const {
  Vector3 result = rest_[0].cross(rest_[1]);
  for (auto i = modes_.begin(); i != modes_.end(); ++i) {
    result += i->vector.cross(i->weights[0] * rest_[1] - i->weights[1] * rest_[0]);
    for (auto j = i + 1; j != modes_.end(); ++j) {
      result += minor(i->weights[0], j->weights[0], i->weights[1], j->weights[1]) *
                i->vector.cross(j->vector);
    }
  }
  return result;
}

double ModeProducts::condition(const Vector3& cross) const {
  // Each vector errs by a share of 1, whatever its length is: of vectors this is the unit here.
  const double *rest = rest_weights_, rest_length = std::max(rest_[0].norm(), rest_[1].norm());
  double error = rest[0] * rest_[1].norm() + rest[1] * rest_[0].norm();
  for (auto i = modes_.begin(); i != modes_.end(); ++i) {
    const double length = i->vector.norm();
    error += (std::abs(i->weights[0]) * rest[1] + std::abs(i->weights[1]) * rest[0]) *
             (length + rest_length);
    for (auto j = i + 1; j != modes_.end(); ++j) {
      error += std::abs(minor(i->weights[0], j->weights[0], i->weights[1], j->weights[1])) *
               (length + j->vector.norm());
    }
  }
  return error / cross.stableNorm();  // deep in a tile its square underflows
}

Vector3 ModeProducts::determinants() const {
  const Vector3 rest_cross = rest_[0].cross(rest_[1]);
  Vector3 result;
  for (int s = 0; s < 3; ++s) {
    result[s] = rest_cross.dot(rest_[2 + s]);
  }
  for (auto i = modes_.begin(); i != modes_.end(); ++i) {
    for (int s = 0; s < 3; ++s) {
      result[s] += i->vector.dot(i->weights[0] * rest_[1].cross(rest_[2 + s]) -
                                 i->weights[1] * rest_[0].cross(rest_[2 + s]) +
                                 i->weights[2 + s] * rest_cross);
    }
    for (auto j = i + 1; j != modes_.end(); ++j) {
      const Vector3 across = i->vector.cross(j->vector);
      const double *p = i->weights, *q = j->weights;
      const double uv = minor(p[0], q[0], p[1], q[1]);
      double us[3], vs[3];  // u or v with each of the second derivatives
      for (int s = 0; s < 3; ++s) {
        us[s] = minor(p[0], q[0], p[2 + s], q[2 + s]);
        vs[s] = minor(p[1], q[1], p[2 + s], q[2 + s]);
        result[s] += across.dot(vs[s] * rest_[0] - us[s] * rest_[1] + uv * rest_[2 + s]);
      }
      for (auto k = j + 1; k != modes_.end(); ++k) {
        const double volume = across.dot(k->vector);
        for (int s = 0; s < 3; ++s) {
          result[s] +=
              volume * (k->weights[0] * vs[s] - k->weights[1] * us[s] + k->weights[2 + s] * uv);
        }
      }
    }
  }
  return result;
}

FundamentalForms ModeProducts::fundamentalForms() const {
  FundamentalForms forms;
  forms.du = sum(0);
  forms.dv = sum(1);
  forms.cross = cross();
  if (!(condition(forms.cross) <= kMostNormalCondition)) {
    forms.cross.setZero();
  }
  const Vector3 bends = determinants() / forms.cross.norm();
  forms.uu = bends[0];
  forms.uv = bends[1];
  forms.vv = bends[2];
  forms.scale = second_ / first_ / first_ / length_;
  return forms;
}

}  // namespace limitsurf
