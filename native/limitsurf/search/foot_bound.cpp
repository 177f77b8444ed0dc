// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/foot_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/float_rounding.h"

namespace limitsurf {
namespace {

/// More than the relative rounding of the bounds.
constexpr double kNearlyOne = 1 - 1e-6;

using Point = BezierPatch::Point;

/// The largest norm of some vectors.
class Largest {
 public:
  void include(const Point& vector) { squared_ = std::max(squared_, vector.square().sum()); }
  double norm() const { return std::sqrt(squared_); }

 private:
  double squared_ = 0;
};

/// The first derivative along one parameter: the mean of its Bezier points, and the largest
/// deviation of one of them.
struct Derivative {
  Derivative(const BezierPatch& patch, int stride, int across) {
    Point all[12];
    mean.setZero();
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        const Point* p = patch.points + across * j + stride * i;
        all[3 * j + i] = 3 * (p[stride] - p[0]);
        mean += all[3 * j + i];
      }
    }
    mean /= 12;
    Largest largest;
    for (const Point& derivative : all) {
      largest.include(derivative - mean);
    }
    deviation = largest.norm();
  }

  Point mean;
  double deviation;
};

/// A bound on the second derivative along one parameter.
double secondAlong(const BezierPatch& patch, int stride, int across) {
  Largest largest;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      const Point* p = patch.points + across * j + stride * i;
      largest.include((p[2 * stride] - p[stride]) - (p[stride] - p[0]));
    }
  }
  return 6 * largest.norm();
}

double mixed(const BezierPatch& patch) {
  Largest largest;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Point* p = patch.points + 4 * j + i;
      largest.include((p[5] - p[4]) - (p[1] - p[0]));
    }
  }
  return 9 * largest.norm();
}

double norm(double x, double y) { return std::sqrt(x * x + y * y); }

/// Bounds on the second derivatives of the patch in some direction.
struct Second {
  double least_ss, least_tt;  ///< at most 0
  double most_ss, most_st;    ///< of the absolute values
};

/// A lower bound, at most 0, of the eigenvalues of the second derivatives with respect to a and b.
double leastEigenvalue(const FootBound& bound, const Second& p) {
  const double ea = bound.ea, eb = bound.eb, skew = bound.skew;
  const double aa = ea * ea * p.least_ss,
               bb = skew * skew * p.least_ss - 2 * skew * eb * p.most_st + eb * eb * p.least_tt,
               ab = ea * (skew * p.most_ss + eb * p.most_st);
  return 0.5 * (aa + bb) - norm(0.5 * (aa - bb), ab);
}

}  // namespace

FootBound::FootBound(const BezierPatch& patch) {
  const Derivative s(patch, 1, 4), t(patch, 4, 1);
  const double length = std::sqrt(s.mean.square().sum());
  const double along = (s.mean * t.mean).sum() / length;
  const double height = std::sqrt((t.mean - along / length * s.mean).square().sum());
  const double a = 1 / length, b = 1 / height, c = std::abs(along) * a * b;
  const double m = 1 - norm(a * s.deviation, c * s.deviation + b * t.deviation);
  if (!(length > 0 && height > 0 && m > 0)) {
    return;
  }
  ea = roundedUp(a);
  eb = roundedUp(b);
  skew = roundedUp(c);
  stretch = roundedDown(kNearlyOne * m * m);
  const double ss = secondAlong(patch, 1, 4), tt = secondAlong(patch, 4, 1), st = mixed(patch);
  const double least = leastEigenvalue(*this, {-ss, -tt, ss, st});
  radius = roundedDown(std::min(stretch / -least, double{std::numeric_limits<float>::max()}));
}

bool FootBound::holds(const double z[16], double distance) const {
  Second second{0, 0, 0, 0};
  double largest = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      const double ss = (z[4 * j + i + 2] - z[4 * j + i + 1]) - (z[4 * j + i + 1] - z[4 * j + i]);
      const double tt = (z[4 * i + 8 + j] - z[4 * i + 4 + j]) - (z[4 * i + 4 + j] - z[4 * i + j]);
      second.least_ss = std::min(second.least_ss, ss);
      largest = std::max(largest, ss);
      second.least_tt = std::min(second.least_tt, tt);
    }
  }
  double mixed = 0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double* p = z + 4 * j + i;
      mixed = std::max(mixed, std::abs((p[5] - p[4]) - (p[1] - p[0])));
    }
  }
  second.most_ss = 6 * std::max(largest, -second.least_ss);
  second.least_ss *= 6;
  second.least_tt *= 6;
  second.most_st = 9 * mixed;
  return stretch > 0 && stretch + distance * leastEigenvalue(*this, second) >= 0;
}

}  // namespace limitsurf
