// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/distance_convexity.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

/// More than the relative rounding of the bounds below.
constexpr double kMargin = 1e-9;

/// One coordinate of differences of control points, for all that begin in a row or a column. Places
/// at which none begins are not used.
constexpr int kPoints = 16;
using Numbers = double[kPoints];

/// Vectors, coordinate by coordinate.
struct Vectors {
  Numbers x, y, z;

  /// The differences of elements that are `stride` apart.
  static void differences(const Vectors& of, int stride, int count, Vectors& out) {
    for (int i = 0; i < count; ++i) {
      out.x[i] = of.x[i + stride] - of.x[i];
      out.y[i] = of.y[i + stride] - of.y[i];
      out.z[i] = of.z[i + stride] - of.z[i];
    }
  }
  void dots(const double v[3], int count, Numbers& out) const {
    for (int i = 0; i < count; ++i) {
      out[i] = x[i] * v[0] + y[i] * v[1] + z[i] * v[2];
    }
  }
  void squares(int count, Numbers& out) const {
    for (int i = 0; i < count; ++i) {
      out[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    }
  }
  void squaresFrom(const double v[3], int count, Numbers& out) const {
    for (int i = 0; i < count; ++i) {
      const double a = x[i] - v[0], b = y[i] - v[1], c = z[i] - v[2];
      out[i] = a * a + b * b + c * c;
    }
  }
};

/// The largest of the numbers in `width` columns and `height` rows.
double largest(const Numbers& values, int width, int height) {
  double most = values[0];
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      most = std::max(most, values[4 * j + i]);
    }
  }
  return most;
}

double smallest(const Numbers& values, int width, int height) {
  double least = values[0];
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      least = std::min(least, values[4 * j + i]);
    }
  }
  return least;
}

double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A ball around the differences in `width` columns and `height` rows.
struct Ball {
  Ball(const Vectors& differences, int width, int height) {
    // The sum of the corners is a cheap middle.
    const int far = width - 1, last = 4 * (height - 1);
    const auto mean = [&](const Numbers& v) {
      return (v[0] + v[far] + v[last] + v[last + far]) / 4;
    };
    middle[0] = mean(differences.x);
    middle[1] = mean(differences.y);
    middle[2] = mean(differences.z);
    Numbers squares;
    differences.squaresFrom(middle, last + width, squares);
    radius = std::sqrt(largest(squares, width, height));
    length = std::sqrt(dot(middle, middle));
  }
  double middle[3], radius, length;
};

/// Bounds of the products of second differences with the offset of the surface from the point.
struct Bent {
  Bent(const Vectors& differences, int width, int height, const Ball& offsets) {
    const int count = 4 * (height - 1) + width;
    Numbers values;
    differences.dots(offsets.middle, count, values);
    low = smallest(values, width, height);
    high = largest(values, width, height);
    differences.squares(count, values);
    const double reach = offsets.radius * std::sqrt(largest(values, width, height));
    low -= reach;
    high += reach;
  }
  double low, high;
};

/// A lower bound of a diagonal entry of the Hessian of half the squared distance. A cubic has
/// derivatives of 3 times the differences of its control points, and second ones of 6 times the
/// second differences; mixed ones of 9 times.
double curvature(const Ball& tangents, const Bent& bent) {
  const double least = std::max(0., tangents.length - tangents.radius);
  const double rounding = kMargin * (9 * tangents.length * tangents.length +
                                     6 * std::max(std::abs(bent.low), std::abs(bent.high)));
  return 9 * least * least + 6 * bent.low - rounding;
}

}  // namespace

bool isConvexDistance(const BezierPatch::Point points[16], const BezierPatch::Point& away) {
  Vectors p, s, t, second;
  for (int i = 0; i < kPoints; ++i) {
    p.x[i] = points[i][0];
    p.y[i] = points[i][1];
    p.z[i] = points[i][2];
  }
  Vectors::differences(p, 1, 15, s);
  Vectors::differences(p, 4, 12, t);
  const Ball along_s(s, 3, 4), along_t(t, 4, 3);
  Ball offsets(p, 4, 4);
  for (int axis = 0; axis < 3; ++axis) {
    offsets.middle[axis] -= away[axis];
  }
  Vectors::differences(s, 1, 14, second);
  const double ss = curvature(along_s, Bent(second, 2, 4, offsets));
  Vectors::differences(t, 4, 8, second);
  const double tt = curvature(along_t, Bent(second, 4, 2, offsets));
  if (!(ss > 0 && tt > 0)) {
    return false;
  }
  Vectors::differences(s, 4, 11, second);
  const Bent mixed(second, 3, 3, offsets);
  const double product = std::abs(dot(along_s.middle, along_t.middle)) +
                         along_s.radius * along_t.length + along_t.radius * along_s.length +
                         along_s.radius * along_t.radius;
  const double st = 9 * (product + std::max({0., mixed.high, -mixed.low}));
  return ss * tt > (1 + kMargin) * st * st;
}

}  // namespace limitsurf
