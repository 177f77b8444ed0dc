// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_cell_nearest.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// The number of steps at most, the damping at first, and the factors by which it changes after a
/// step that led nearer and after one that did not. Chosen, not derived.
constexpr int kMostSteps = 60;
constexpr double kFirstDamping = 1e-3, kLessDamping = 0.1, kMoreDamping = 10;

double squared(const Point2& a) { return (a * a).sum(); }

/// The damped, linearised square of the distance as a function of the step. The damping is relative
/// to each derivative, since the sides of a cell may be of very different lengths.
struct QuadraticModel {
  QuadraticModel(const Point2& of_rest, const Point2& ds, const Point2& dt, double damping)
      : rest(of_rest), d{ds, dt}, added(damping * squared(ds), damping * squared(dt)) {}

  Point2 rest, d[2], added;

  double at(const Point2& step) const {
    return squared(rest - step[0] * d[0] - step[1] * d[1]) + (added * step * step).sum();
  }
  /// Where it is least on the whole plane.
  Point2 least() const {
    const double ss = squared(d[0]) + added[0], st = (d[0] * d[1]).sum(),
                 tt = squared(d[1]) + added[1];
    const double s = (d[0] * rest).sum(), t = (d[1] * rest).sum();
    const double determinant = ss * tt - st * st;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return determinant > 0 ? Point2(Point2(tt * s - st * t, ss * t - st * s) / determinant)
                           : leastBeside(ss > tt ? 1 : 0, 0, -kFar, kFar);
  }
  /// Where it is least if one coordinate of the step is fixed, with the other from low to high.
  Point2 leastBeside(int fixed, double value, double low, double high) const {
    const int free = 1 - fixed;
    const double along = (d[free] * (rest - value * d[fixed])).sum();
    Point2 step;
    step[fixed] = value;
    step[free] = std::clamp(along / (squared(d[free]) + added[free]), low, high);
    return step;
  }
};

}  // namespace

CellNearest::CellNearest(const UvCell& cell, const Point2& target, const Point2& tolerance,
                         const Point2& start)
    : cell_(cell), target_(target), tolerance_(tolerance), at_(start) {
  evaluate(at_, rest_, ds_, dt_);
  double damping = kFirstDamping;
  for (int count = 0; count < kMostSteps; ++count) {
    const Point2 next = (at_ + step(damping)).max(0.).min(1.);
    if ((next == at_).all() || !next.allFinite()) {
      break;
    }
    Point2 rest, ds, dt;
    evaluate(next, rest, ds, dt);
    if (squared(rest) < squared(rest_)) {
      at_ = next;
      rest_ = rest;
      ds_ = ds;
      dt_ = dt;
      damping *= kLessDamping;
    } else {
      damping *= kMoreDamping;
    }
  }
}

Point2 CellNearest::step(double damping) const {
  const QuadraticModel model(rest_, ds_, dt_, damping);
  const Point2 low = -at_, high = 1 - at_, free = model.least();
  Point2 best = free;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2; ++i) {
    if (free[i] < low[i] || free[i] > high[i]) {
      const double side = free[i] < low[i] ? low[i] : high[i];
      const Point2 beside = model.leastBeside(i, side, low[1 - i], high[1 - i]);
      const double value = model.at(beside);
      if (value < least) {
        least = value;
        best = beside;
      }
    }
  }
  return best;
}

void CellNearest::evaluate(const Point2& at, Point2& rest, Point2& ds, Point2& dt) const {
  Point2 value;
  cell_.evaluate(at[0], at[1], value, ds, dt);
  rest = (target_ - value) / tolerance_;
  ds /= tolerance_;
  dt /= tolerance_;
}

}  // namespace limitsurf
