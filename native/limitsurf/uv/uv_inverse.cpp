// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_inverse.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// The control points of the four sides of a cell.
constexpr int kSides[4][4] = {{0, 1, 2, 3}, {12, 13, 14, 15}, {0, 4, 8, 12}, {3, 7, 11, 15}};

/// Bounds of the part of a cell's image that lies in a row: the image ends at the sides of the
/// cell, and these lie in the hulls of their control points.
class RowRange {
 public:
  RowRange(const UvCell& cell, const Point2& tolerance) : cell_(cell), tolerance_(tolerance) {}

  Box2 at(double y) const {
    Box2 range;
    for (const auto& side : kSides) {
      for (int i = 0; i < 3; ++i) {
        for (int j = i + 1; j < 4; ++j) {
          addPart(cell_.points[side[i]], cell_.points[side[j]], y, range);
        }
      }
    }
    return range;
  }

 private:
  /// Includes the part of the line from a to b that lies in the row.
  void addPart(const Point2& a, const Point2& b, double y, Box2& range) const {
    const double low = y - tolerance_[1], high = y + tolerance_[1];
    if (std::max(a[1], b[1]) < low || std::min(a[1], b[1]) > high) {
      return;
    }
    for (const double level : {low, high}) {
      const double part = a[1] == b[1] ? 0 : std::clamp((level - a[1]) / (b[1] - a[1]), 0., 1.);
      range.include({a[0] + part * (b[0] - a[0]), y});
    }
    if (a[1] == b[1]) {
      range.include({b[0], y});
    }
  }

  const UvCell& cell_;
  const Point2 tolerance_;
};

/// The place in a cell whose image is nearest to a point, by the Levenberg-Marquardt iteration from
/// the middle of the cell.
class LeastSquares {
 public:
  LeastSquares(const UvCell& cell, const Point2& target) : cell_(cell), target_(target) {
    evaluate(at_, rest_, ds_, dt_);
    double damping = kFirstDamping;
    for (int step = 0; step < kMostSteps && rest_.matrix().squaredNorm() > 0; ++step) {
      const double ss = (ds_ * ds_).sum(), st = (ds_ * dt_).sum(), tt = (dt_ * dt_).sum();
      const double added = damping * (ss + tt);
      const Point2 right((ds_ * rest_).sum(), (dt_ * rest_).sum());
      const double determinant = (ss + added) * (tt + added) - st * st;
      const Point2 move =
          Point2((tt + added) * right[0] - st * right[1], (ss + added) * right[1] - st * right[0]) /
          determinant;
      const Point2 next = (at_ + move).max(0.).min(1.);
      Point2 rest, ds, dt;
      evaluate(next, rest, ds, dt);
      if (rest.matrix().squaredNorm() < rest_.matrix().squaredNorm()) {
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

  double s() const { return at_[0]; }
  double t() const { return at_[1]; }
  const Point2& rest() const { return rest_; }
  double determinant() const { return cross(ds_, dt_); }

 private:
  /// The number of steps at most, the damping at first relative to the trace of the matrix, and the
  /// factors by which it changes after a step that led nearer and after one that did not. Chosen,
  /// not derived.
  static constexpr int kMostSteps = 60;
  static constexpr double kFirstDamping = 1e-3, kLessDamping = 0.1, kMoreDamping = 10;

  void evaluate(const Point2& at, Point2& rest, Point2& ds, Point2& dt) const {
    Point2 value;
    cell_.evaluate(at[0], at[1], value, ds, dt);
    rest = target_ - value;
  }

  const UvCell& cell_;
  const Point2 target_;
  Point2 at_ = Point2::Constant(0.5);
  Point2 rest_, ds_, dt_;
};

}  // namespace

bool LatticeInverse::isFlat(const UvCell& patch) const {
  const Box2 box = patch.box();
  const JacobianBounds jacobian(patch);
  const double area = std::max(std::abs(jacobian.least), std::abs(jacobian.largest));
  return !(area > tolerance_.maxCoeff() * (box.high - box.low).maxCoeff());
}

bool LatticeInverse::isBeside(const UvCell& cell, const Lattice& inside) const {
  const Point2 *p = cell.points, one = p[15] - p[0], other = p[12] - p[3];
  const Point2 along = (one * one).sum() > (other * other).sum() ? one : other;
  const double tolerance = (along.abs() * tolerance_.reverse()).sum();
  for (int y = inside.y0; y <= inside.y1; ++y) {
    for (int x = inside.x0; x <= inside.x1; ++x) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int i = 0; i < 16; ++i) {
        const double across = cross(along, p[i] - Point2(x, y));
        low = std::min(low, across);
        high = std::max(high, across);
      }
      if (low <= tolerance && high >= -tolerance) {
        return false;
      }
    }
  }
  return true;
}

void LatticeInverse::add(const UvCell& patch) {
  if (!within(patch.box()).empty() && !isFlat(patch)) {
    deep_cells_ = 0;
    addCell(patch, 0);
  }
}

void LatticeInverse::addPart(const UvCell& part) {
  const Lattice inside = within(part.box());
  if (inside.empty()) {
    return;
  }
  if (isFlat(part)) {
    addNearest(part, inside);
  } else {
    deep_cells_ = 0;
    addCell(part, 0);
  }
}

void LatticeInverse::addCell(const UvCell& cell, int depth) {
  const Box2 box = cell.box();
  const Lattice inside = within(box);
  if (inside.empty()) {
    return;
  }
  CellInverse inverse;
  if (inverse.set(cell, tolerance_)) {
    addRows(cell, inverse, inside);
    return;
  }
  if (depth > 0 && inside.x1 - inside.x0 < 2 && inside.y1 - inside.y0 < 2 &&
      isBeside(cell, inside)) {
    return;
  }
  const bool is_last =
      depth >= kQuarterings && (depth == kMostQuarterings || deep_cells_++ > kMostDeepCells);
  if (is_last || ((box.high - box.low) <= kTiny * tolerance_).all()) {
    addNearest(cell, inside);
    return;
  }
  UvCell quarters[4];
  cell.quarter(quarters);
  for (const UvCell& quarter : quarters) {
    addCell(quarter, depth + 1);
  }
}

void LatticeInverse::addRows(const UvCell& cell, const CellInverse& inverse,
                             const Lattice& inside) {
  const RowRange rows(cell, tolerance_);
  for (int y = inside.y0; y <= inside.y1; ++y) {
    const Lattice row = Lattice{inside.x0, y, inside.x1, y}.within(
        rows.at(y).grown({tolerance_[0], tolerance_[1]}));
    CellInverse::Place place;
    Point2 last = Point2::Zero(), step = Point2::Zero(), before = Point2::Zero();
    for (int x = row.x0; x <= row.x1; ++x) {
      const Point2 target(x, y);
      const int done = x - row.x0;
      // The start is extrapolated, quadratically as soon as three points are known.
      place.x = done == 0 ? inverse.guess(target)
                          : Point2(last + (done > 2 ? Point2(2 * step - before) : step));
      if (inverse.find(target, place)) {
        addPlace(cell, inverse, place, x, y);
      }
      if (done == 0) {
        step = Point2(place.dt[1], -place.ds[1]) / place.determinant;
      } else {
        before = step;
        step = place.beyond - last;
      }
      last = place.beyond;
    }
  }
}

void LatticeInverse::addPlace(const UvCell& cell, const CellInverse& inverse,
                              const CellInverse::Place& place, int x, int y) {
  Find find;
  find.x = x;
  find.y = y;
  find.s = cell.s0 + cell.size * (place.x[0] + 0.5);
  find.t = cell.t0 + cell.size * (place.x[1] + 0.5);
  find.flipped = place.determinant < 0;
  const Point2 from_sides = 0.5 - place.x.abs();
  if (from_sides.minCoeff() <= inverse.borderWidth()) {
    // The wedge lies between the directions along the sides, counter-clockwise in s and t.
    const bool at_s = from_sides[0] <= inverse.borderWidth();
    const bool at_t = from_sides[1] <= inverse.borderWidth();
    const bool s_low = place.x[0] < 0, t_low = place.x[1] < 0;
    Point2 ds, dt;
    inverse.derivatives(place.x, ds, dt);
    Wedge wedge;
    if (at_s && at_t) {
      const Point2 along_s = s_low ? ds : Point2(-ds), along_t = t_low ? dt : Point2(-dt);
      wedge = s_low == t_low ? Wedge{along_s, along_t} : Wedge{along_t, along_s};
    } else if (at_s) {
      wedge = s_low ? Wedge{-dt, dt} : Wedge{dt, -dt};
    } else {
      wedge = t_low ? Wedge{ds, -ds} : Wedge{-ds, ds};
    }
    if (find.flipped) {
      std::swap(wedge.first, wedge.last);
    }
    find.on_border = true;
    find.wedge_count = inverse.borderWidth() <= kWidestBorder ? 1 : 0;
    find.wedges[0] = wedge;
  }
  sink_.add(find);
}

void LatticeInverse::addNearest(const UvCell& cell, const Lattice& inside) {
  for (int y = inside.y0; y <= inside.y1; ++y) {
    for (int x = inside.x0; x <= inside.x1; ++x) {
      LeastSquares search(cell, Point2(x, y));
      if ((search.rest().abs() <= tolerance_).all()) {
        Find find;
        find.x = x;
        find.y = y;
        find.s = cell.s0 + cell.size * search.s();
        find.t = cell.t0 + cell.size * search.t();
        find.flipped = search.determinant() < 0;
        find.on_border = true;
        sink_.add(find);
      }
    }
  }
}

}  // namespace limitsurf
