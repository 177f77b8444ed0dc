// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The cross product of vectors with the padding that patches have.
inline Vector3 cross(const BezierPatch::Point& a, const BezierPatch::Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
inline double length(const BezierPatch::Point& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/// The vector ds x dt on a rectangle of a patch: a polynomial of degree 5 in s and in t, in Bezier
/// form. Its length is the area of the surface per area of (s, t), the patch's own parameters.
class AreaForm {
 public:
  explicit AreaForm(const BezierPatch& patch) {
    // Product of Bernstein polynomials: the binomials of the factors over those of the product.
    constexpr double kTwo[3] = {1, 2, 1}, kThree[4] = {1, 3, 3, 1};
    constexpr double kFive[6] = {1, 5, 10, 10, 5, 1};
    BezierPatch::Point ds[4][3], dt[3][4];
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        const BezierPatch::Point* p = patch.points;
        ds[j][i] = 3 * kThree[j] * kTwo[i] * (p[4 * j + i + 1] - p[4 * j + i]);
        dt[i][j] = 3 * kTwo[i] * kThree[j] * (p[4 * (i + 1) + j] - p[4 * i + j]);
      }
    }
    for (Vector3& c : points_) {
      c.setZero();
    }
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        for (int l = 0; l < 3; ++l) {
          for (int k = 0; k < 4; ++k) {
            points_[6 * (j + l) + i + k] += cross(ds[j][i], dt[l][k]);
          }
        }
      }
    }
    for (int b = 0; b < 6; ++b) {
      for (int a = 0; a < 6; ++a) {
        points_[6 * b + a] /= kFive[a] * kFive[b];
      }
    }
  }

  /// Upper bound of the length on the rectangle.
  double bound() const {
    double squared = 0;
    for (const Vector3& p : points_) {
      squared = std::max(squared, p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    }
    return std::sqrt(squared) * (1 + kRounding);
  }

  /// Upper bound of the length of its derivative along s or t.
  double derivativeBound(bool along_t) const {
    const int step = along_t ? 6 : 1, across = along_t ? 1 : 6;
    double bound = 0;
    for (int line = 0; line < 6; ++line) {
      for (int i = 0; i < 5; ++i) {
        const Vector3* p = points_ + across * line + step * i;
        bound = std::max(bound, length(Vector3(p[step] - p[0])));
      }
    }
    return 5 * bound;
  }

  /// Upper bounds of the lengths of its second derivatives.
  struct SecondBounds {
    double ss = 0, st = 0, tt = 0;
  };
  SecondBounds secondDerivativeBounds() const {
    SecondBounds bounds;
    const auto raise = [](double& bound, const Vector3& difference, double factor) {
      bound = std::max(bound, factor * length(difference));
    };
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 6; ++i) {
        const Vector3* p = points_ + 6 * j + i;
        if (i < 4) {
          raise(bounds.ss, (p[2] - p[1]) - (p[1] - p[0]), 5 * 4);
        }
        if (j < 4) {
          raise(bounds.tt, (p[12] - p[6]) - (p[6] - p[0]), 5 * 4);
        }
        if (i < 5 && j < 5) {
          raise(bounds.st, (p[7] - p[6]) - (p[1] - p[0]), 5 * 5);
        }
      }
    }
    return bounds;
  }

  /// The form on the lower (0) or upper (1) half of the rectangle along s or t.
  AreaForm half(bool along_t, int which) const {
    AreaForm result = *this;
    const int step = along_t ? 6 : 1, across = along_t ? 1 : 6;
    for (int line = 0; line < 6; ++line) {
      Vector3* p = result.points_ + across * line;
      for (int done = 1; done < 6; ++done) {
        if (which == 0) {
          for (int i = 5; i >= done; --i) {
            p[step * i] = 0.5 * (p[step * (i - 1)] + p[step * i]);
          }
        } else {
          for (int i = 0; i < 6 - done; ++i) {
            p[step * i] = 0.5 * (p[step * i] + p[step * (i + 1)]);
          }
        }
      }
    }
    return result;
  }

  /// Mean length, by the midpoint rule on 4 x 4 points.
  double mean() const;

 private:
  /// More than the relative rounding error of the coefficients.
  static constexpr double kRounding = 1e-12;

  Vector3 points_[36];
};

inline double AreaForm::mean() const {
  // Bernstein polynomials of degree 5 at 1/8 and 3/8; at 5/8 and 7/8 they run backwards.
  static constexpr double kAt[2][6] = {
      {16807. / 32768, 12005. / 32768, 3430. / 32768, 490. / 32768, 35. / 32768, 1. / 32768},
      {3125. / 32768, 9375. / 32768, 11250. / 32768, 6750. / 32768, 2025. / 32768, 243. / 32768}};
  const auto weight = [](int place, int i) {
    return place < 2 ? kAt[place][i] : kAt[3 - place][5 - i];
  };
  double sum = 0;
  for (int y = 0; y < 4; ++y) {
    Vector3 row[6];
    for (int a = 0; a < 6; ++a) {
      row[a].setZero();
      for (int b = 0; b < 6; ++b) {
        row[a] += weight(y, b) * points_[6 * b + a];
      }
    }
    for (int x = 0; x < 4; ++x) {
      Vector3 value = Vector3::Zero();
      for (int a = 0; a < 6; ++a) {
        value += weight(x, a) * row[a];
      }
      sum += length(value);
    }
  }
  return sum / 16;
}

}  // namespace limitsurf
