// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_folds.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace limitsurf {
namespace {

double crossProduct(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }
double dotProduct(const double a[2], const double b[2]) { return a[0] * b[0] + a[1] * b[1]; }

/// The vectors of a plane that are turned farthest clockwise and counter-clockwise.
struct Extremes {
  double clockwise[2], counter_clockwise[2];
};

/// Returns false unless all vectors lie within 90 degrees of the middle one.
bool findExtremes(const double (&vectors)[12][2], const double middle[2], Extremes& out) {
  out = {{middle[0], middle[1]}, {middle[0], middle[1]}};
  for (const double (&p)[2] : vectors) {
    if (!(dotProduct(p, middle) > 0)) {
      return false;
    }
    if (crossProduct(out.counter_clockwise, p) > 0) {
      out.counter_clockwise[0] = p[0];
      out.counter_clockwise[1] = p[1];
    } else if (crossProduct(out.clockwise, p) < 0) {
      out.clockwise[0] = p[0];
      out.clockwise[1] = p[1];
    }
  }
  return true;
}

}  // namespace

AreaFolds::AreaFolds(const Points& points) {
  for (int axis = 0; axis < 3; ++axis) {
    const double* p = points[axis];
    for (int row = 0; row < 4; ++row) {
      for (int i = 0; i < 3; ++i) {
        ds_[axis][row][i] = 3 * (p[4 * row + i + 1] - p[4 * row + i]);
      }
    }
    for (int row = 0; row < 3; ++row) {
      for (int i = 0; i < 4; ++i) {
        dt_[axis][row][i] = 3 * (p[4 * row + 4 + i] - p[4 * row + i]);
      }
    }
  }
}

bool AreaFolds::isUpright() const {
  const auto middle = [](const double* p, int count) {
    // The middle ones of a row of four, or of three, count most.
    return count == 4 ? p[0] + 3 * (p[1] + p[2]) + p[3] : p[0] + 2 * p[1] + p[2];
  };
  Vector3 s, t;
  for (int axis = 0; axis < 3; ++axis) {
    double along_s[4], along_t[3];
    for (int row = 0; row < 4; ++row) {
      along_s[row] = middle(ds_[axis][row], 3);
    }
    for (int row = 0; row < 3; ++row) {
      along_t[row] = middle(dt_[axis][row], 4);
    }
    s[axis] = middle(along_s, 4);
    t[axis] = middle(along_t, 3);
  }
  // Axes of the tangent plane in the middle. Their lengths do not matter.
  const Vector3 normal = s.cross(t), y_axis = normal.cross(s).normalized() * s.norm();
  const auto projected = [&](const Vector3& p, double out[2]) {
    out[0] = p.dot(s);
    out[1] = p.dot(y_axis);
  };
  double of_s[12][2], of_t[12][2], middle_s[2], middle_t[2];
  for (int i = 0; i < 12; ++i) {
    projected({ds_[0][i / 3][i % 3], ds_[1][i / 3][i % 3], ds_[2][i / 3][i % 3]}, of_s[i]);
    projected({dt_[0][i / 4][i % 4], dt_[1][i / 4][i % 4], dt_[2][i / 4][i % 4]}, of_t[i]);
  }
  projected(s, middle_s);
  projected(t, middle_t);
  // ds x dt is a mean of cross products of these vectors. From any ds to any dt it is a turn by
  // more than 0 and less than 180 degrees if that is so for the smallest turn and the largest one.
  Extremes extreme_s, extreme_t;
  return findExtremes(of_s, middle_s, extreme_s) && findExtremes(of_t, middle_t, extreme_t) &&
         crossProduct(extreme_s.counter_clockwise, extreme_t.clockwise) > 0 &&
         crossProduct(extreme_s.clockwise, extreme_t.counter_clockwise) > 0;
}

AreaFolds::Parts AreaFolds::parts() const {
  // ds x dt in Bezier form, of degree 5 in both directions: the binomials of the factors over those
  // of the product.
  constexpr double kTwo[3] = {1, 2, 1}, kThree[4] = {1, 3, 3, 1};
  constexpr double kFive[6] = {1, 5, 10, 10, 5, 1};
  Vector3 form[36], sum = Vector3::Zero();
  for (Vector3& c : form) {
    c.setZero();
  }
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Vector3 s(ds_[0][j][i], ds_[1][j][i], ds_[2][j][i]);
      for (int l = 0; l < 3; ++l) {
        for (int k = 0; k < 4; ++k) {
          const Vector3 t(dt_[0][l][k], dt_[1][l][k], dt_[2][l][k]);
          form[6 * (j + l) + i + k] += kThree[j] * kTwo[i] * kTwo[l] * kThree[k] * s.cross(t);
        }
      }
    }
  }
  for (int b = 0; b < 6; ++b) {
    for (int a = 0; a < 6; ++a) {
      form[6 * b + a] /= kFive[a] * kFive[b] * 36;
      sum += form[6 * b + a];
    }
  }
  Parts result = {sum.norm(), 0};
  if (result.signed_area > 0) {
    const Vector3 normal = sum / result.signed_area;
    for (const Vector3& c : form) {
      result.turned += std::max(0., -normal.dot(c));
    }
  }
  return result;
}

}  // namespace limitsurf
