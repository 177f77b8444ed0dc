// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/squared_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limitsurf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The relative rounding of differences of coefficients.
constexpr double kRounding = 1e-14;
/// A polynomial of degree 6 has second derivatives of 6 * 5 = 30 times the second differences of
/// its coefficients, and mixed ones of 6 * 6 = 36 times the mixed differences.
constexpr double kSecond = 30, kMixed = 36;

}  // namespace

SquaredDistance::SquaredDistance(const SearchKernels& kernels, const BezierPatch::Point points[16],
                                 const BezierPatch::Point& away)
    : kernels_(&kernels) {
  static_assert(
      Bernstein<6>::kStride == kDistanceStride && sizeof f_ == sizeof(double[kDistanceSize]),
      "the kernels write the coefficients");
  kernels.squaredDistance(numbersOf(points), away.data(), f_.data());
  kernels.extremes(f_.data(), least_, largest_);
  const double range = std::sqrt(away.square().sum());
  if (range > 0) {
    for (int i = 0; i < 16; ++i) {
      const double length = std::sqrt(points[i].square().sum());
      summands_ = std::max(summands_, length * (length + 2 * range));
    }
  }
}

int SquaredDistance::slopeAlong(unsigned side) const {
  const int end = side & (kSideS0 | kSideT0) ? 0 : 6;
  const bool along_t = (side & (kSideS0 | kSideS1)) != 0;
  double least = kInfinity, largest = -kInfinity;
  for (int i = 0; i < 6; ++i) {
    const double slope =
        along_t ? f_.at(end, i + 1) - f_.at(end, i) : f_.at(i + 1, end) - f_.at(i, end);
    least = std::min(least, slope);
    largest = std::max(largest, slope);
  }
  const double rounding = kRounding * magnitude();
  return least > rounding ? 1 : largest < -rounding ? -1 : 0;
}

void SquaredDistance::divide(Division along, SquaredDistance out[4]) const {
  if (along == Division::t) {
    f_.halveAlongT(out[0].f_, out[2].f_);
    out[0].finish(*this);
    out[2].finish(*this);
    return;
  }
  f_.halveAlongS(out[0].f_, out[1].f_);
  for (int half = 0; half < 2; ++half) {
    if (along == Division::both) {
      out[half].f_.halveAlongT(out[half].f_, out[half + 2].f_);
      out[half + 2].finish(*this);
    }
    out[half].finish(*this);
  }
}

void SquaredDistance::finish(const SquaredDistance& whole) {
  kernels_ = whole.kernels_;
  summands_ = whole.summands_;
  kernels_->extremes(f_.data(), least_, largest_);
}

void SquaredDistance::guess(double& s, double& t) const {
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 7; ++i) {
      if (f_.at(i, j) == least_) {
        s = i / 6.;
        t = j / 6.;
        return;
      }
    }
  }
}

SquaredDistance::Shape SquaredDistance::shape(double slack) const {
  Shape shape;
  const double rounding = kRounding * magnitude();
  DifferenceBounds d;
  kernels_->differenceBounds(f_.row(0), d);
  shape.s_bend = std::max(-d.least_ss, d.largest_ss);
  shape.t_bend = std::max(-d.least_tt, d.largest_tt);
  shape.s_side = d.least_s >= 0 ? -1 : d.largest_s <= 0 ? 1 : 0;
  shape.s_strictly = d.least_s > rounding || d.largest_s < -rounding;
  shape.t_side = d.least_t >= 0 ? -1 : d.largest_t <= 0 ? 1 : 0;
  shape.t_strictly = d.least_t > rounding || d.largest_t < -rounding;

  if (shape.s_side != 0 && shape.t_side != 0) {
    shape.convex = true;
  } else if (shape.s_side != 0) {
    const int i = shape.s_side < 0 ? 0 : 6;
    double second = kInfinity;
    for (int j = 0; j < 5; ++j) {
      second = std::min(second, f_.at(i, j) - 2 * f_.at(i, j + 1) + f_.at(i, j + 2));
    }
    shape.convex = kSecond * second + slack > 0;
  } else if (shape.t_side != 0) {
    const int j = shape.t_side < 0 ? 0 : 6;
    double second = kInfinity;
    for (int i = 0; i < 5; ++i) {
      second = std::min(second, f_.at(i, j) - 2 * f_.at(i + 1, j) + f_.at(i + 2, j));
    }
    shape.convex = kSecond * second + slack > 0;
  } else {
    shape.convex = isConvex(d, slack);
  }
  return shape;
}

bool SquaredDistance::isConvex(const DifferenceBounds& d, double slack) {
  const double ss = kSecond * d.least_ss + slack, tt = kSecond * d.least_tt + slack;
  const double st = kMixed * std::max(std::abs(d.least_st), std::abs(d.largest_st));
  return ss > 0 && tt > 0 && ss * tt >= st * st;
}

bool SquaredDistance::isNowhereConvex() const {
  DifferenceBounds d;
  kernels_->differenceBounds(f_.row(0), d);
  const double rounding = kRounding * magnitude();
  const double st = kMixed * std::max({0., d.least_st, -d.largest_st});
  return d.largest_ss < -rounding || d.largest_tt < -rounding ||
         kSecond * (d.largest_ss + rounding) * kSecond * (d.largest_tt + rounding) < st * st;
}

}  // namespace limitsurf
