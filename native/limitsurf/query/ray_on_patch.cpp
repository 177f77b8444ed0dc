// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/query/ray_on_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/bernstein.h"

namespace limitsurf {

RayFrame::RayFrame(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
  int least;
  direction.cwiseAbs().minCoeff(&least);
  across[0] = direction.cross(Vector3::Unit(least)).normalized();
  across[1] = direction.cross(across[0]);
}

void CollectedHits::add(const RayHit& hit) {
  if (!first_only) {
    hits.push_back(hit);
  } else if (hit.distance < nearest) {
    nearest = hit.distance;
    hits.assign(1, hit);
  }
}

namespace {

using Cubic = Bernstein<3>;

/// A cell of the patch as the ray sees it.
struct Cell {
  double s, t, size;
  int depth;
  Cubic x, y;  ///< across the ray
  Cubic z;     ///< along it
};

/// The patch's mean derivatives on a cell, from the differences of its corners, and what makes the
/// unit matrix of them.
struct Precondition {
  explicit Precondition(const Cell& cell) {
    xs = mean(cell.x, true);
    xt = mean(cell.x, false);
    ys = mean(cell.y, true);
    yt = mean(cell.y, false);
    determinant = xs * yt - xt * ys;
    scale = std::hypot(xs, ys) * std::hypot(xt, yt);
  }

  bool isSingular() const { return !(std::abs(determinant) > 1e-9 * scale); }

  static double mean(const Cubic& f, bool along_s) {
    return along_s ? ((f.at(3, 0) - f.at(0, 0)) + (f.at(3, 3) - f.at(0, 3))) / 2
                   : ((f.at(0, 3) - f.at(0, 0)) + (f.at(3, 3) - f.at(3, 0))) / 2;
  }

  double xs, xt, ys, yt, determinant, scale;
};

class PatchRay {
 public:
  PatchRay(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out)
      : patch_(patch), ray_(ray), out_(out) {}

  void run() {
    Cell whole{0, 0, 1, 0, {}, {}, {}};
    const Vector3 offset = patch_.anchor.head<3>().matrix() - ray_.origin;
    const double x0 = offset.dot(ray_.across[0]), y0 = offset.dot(ray_.across[1]),
                 z0 = offset.dot(ray_.direction);
    for (int i = 0; i < 16; ++i) {
      const Vector3 point = patch_.points[i].head<3>();
      whole.x.at(i & 3, i >> 2) = x_[i] = x0 + point.dot(ray_.across[0]);
      whole.y.at(i & 3, i >> 2) = y_[i] = y0 + point.dot(ray_.across[1]);
      whole.z.at(i & 3, i >> 2) = z_[i] = z0 + point.dot(ray_.direction);
    }
    visit(whole);
  }

 private:
  /// Cells in which a patch's second differences are below rounding.
  static constexpr int kMostDepth = 26;
  /// From here on a cell may be the place where the ray touches the patch.
  static constexpr int kTouchDepth = 2;
  /// Rays that stay within the tolerance of a patch for long are not followed any further.
  static constexpr int kDeep = 8, kMostDeepCells = 1 << 13;
  /// At smaller angles the ray runs within the surface: of that only the beginning is kept.
  static constexpr double kWithinSine = 1e-9;
  /// At smaller angles the tolerance is left by the surface's curvature, along its root.
  static constexpr double kLeastSine = 1e-7;

  static bool isWithin(const Cubic& f, double margin) {
    return f.least() >= -margin && f.largest() <= margin;
  }

  static bool misses(const Cubic& f, double margin) {
    return f.least() > margin || f.largest() < -margin;
  }

  bool isBeyond(const Cell& cell) const {
    return cell.z.least() > out_.nearest || cell.z.largest() < out_.from - out_.tolerance;
  }

  void visit(const Cell& cell) {
    if (misses(cell.x, out_.margin()) || misses(cell.y, out_.margin()) || isBeyond(cell)) {
      return;
    }
    if (isWithin(cell.x, out_.tolerance) && isWithin(cell.y, out_.tolerance)) {
      touchCorner(cell);
      return;
    }
    const Precondition p(cell);
    if (!p.isSingular()) {
      // As seen by its own parameters: nearly s - s0 and t - t0, the hit being (s0, t0).
      Cubic a, b;
      const double inverse = 1 / p.determinant;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const double x = cell.x.at(i, j), y = cell.y.at(i, j);
          a.at(i, j) = (p.yt * x - p.xt * y) * inverse;
          b.at(i, j) = (p.xs * y - p.ys * x) * inverse;
        }
      }
      const double margin = out_.margin() * std::abs(inverse);
      if (misses(a, margin * (std::abs(p.yt) + std::abs(p.xt))) ||
          misses(b, margin * (std::abs(p.ys) + std::abs(p.xs)))) {
        return;
      }
      if (isInjective(a, b)) {
        double s = cell.s + cell.size / 2, t = cell.t + cell.size / 2;
        if (solve(cell, s, t)) {
          report(s, t);
          return;
        }
      }
    }
    if (cell.depth >= kTouchDepth && touchesIn(cell)) {
      return;
    }
    if (cell.depth == kMostDepth || (cell.depth >= kDeep && ++deep_cells_ > kMostDeepCells)) {
      return;
    }
    divide(cell);
  }

  /// All of the cell is as near to the ray as matters.
  void touchCorner(const Cell& cell) {
    for (int corner = 0; corner < 4; ++corner) {
      const double s = cell.s + (corner & 1) * cell.size, t = cell.t + (corner >> 1) * cell.size;
      touch(s, t, along(s, t));
    }
  }

  void touch(double s, double t, double z) {
    if (!counts(z)) {
      return;
    }
    if (out_.first_only || sineAt(s, t) > kWithinSine) {
      out_.add(hitAt(s, t, z));
    } else if (within_ >= out_.hits.size()) {
      within_ = out_.hits.size();
      out_.add(hitAt(s, t, z));
    } else if (z < out_.hits[within_].distance) {
      out_.hits[within_] = hitAt(s, t, z);
    }
  }

  void divide(const Cell& cell) {
    Cubic x[4], y[4], z[4];
    cell.x.quarter(x);
    cell.y.quarter(y);
    cell.z.quarter(z);
    double near[4];
    int order[4] = {0, 1, 2, 3};
    for (int q = 0; q < 4; ++q) {
      near[q] = z[q].least();
    }
    std::sort(order, order + 4,
              [&](int i, int j) { return near[i] != near[j] ? near[i] < near[j] : i < j; });
    const double half = cell.size / 2;
    for (const int q : order) {
      visit({cell.s + (q & 1) * half, cell.t + (q >> 1) * half, half, cell.depth + 1, x[q], y[q],
             z[q]});
    }
  }

  /// Whether no two points of the cell are seen at the same place: the preconditioned derivatives
  /// stay near the unit matrix.
  static bool isInjective(const Cubic& a, const Cubic& b) {
    double as = kFar, bt = kFar, at = 0, bs = 0;
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        as = std::min(as, a.at(i + 1, j) - a.at(i, j));
        bs = std::max(bs, std::abs(b.at(i + 1, j) - b.at(i, j)));
        bt = std::min(bt, b.at(j, i + 1) - b.at(j, i));
        at = std::max(at, std::abs(a.at(j, i + 1) - a.at(j, i)));
      }
    }
    return as > 0 && bt > 0 && as * bt > at * bs;
  }

  struct Seen {
    double x, y, xs, ys, xt, yt;
  };

  static void bernstein(double t, double value[4], double first[3]) {
    const double s = 1 - t;
    value[0] = s * s * s;
    value[1] = 3 * s * s * t;
    value[2] = 3 * s * t * t;
    value[3] = t * t * t;
    first[0] = 3 * s * s;
    first[1] = 6 * s * t;
    first[2] = 3 * t * t;
  }

  Seen look(double s, double t) const {
    double vs[4], ds[3], vt[4], dt[3];
    bernstein(s, vs, ds);
    bernstein(t, vt, dt);
    Seen seen{};
    double rows_x[4], rows_y[4];
    for (int j = 0; j < 4; ++j) {
      const double *x = x_ + 4 * j, *y = y_ + 4 * j;
      rows_x[j] = vs[0] * x[0] + vs[1] * x[1] + vs[2] * x[2] + vs[3] * x[3];
      rows_y[j] = vs[0] * y[0] + vs[1] * y[1] + vs[2] * y[2] + vs[3] * y[3];
      seen.xs += vt[j] * (ds[0] * (x[1] - x[0]) + ds[1] * (x[2] - x[1]) + ds[2] * (x[3] - x[2]));
      seen.ys += vt[j] * (ds[0] * (y[1] - y[0]) + ds[1] * (y[2] - y[1]) + ds[2] * (y[3] - y[2]));
      seen.x += vt[j] * rows_x[j];
      seen.y += vt[j] * rows_y[j];
    }
    for (int j = 0; j < 3; ++j) {
      seen.xt += dt[j] * (rows_x[j + 1] - rows_x[j]);
      seen.yt += dt[j] * (rows_y[j + 1] - rows_y[j]);
    }
    return seen;
  }

  /// Newton's step; where that leads out of the cell, the one to the nearest point on the side.
  static void step(const Seen& f, const Cell& cell, double s, double t, double& next_s,
                   double& next_t) {
    const double determinant = f.xs * f.yt - f.xt * f.ys;
    const double s1 = cell.s + cell.size, t1 = cell.t + cell.size;
    next_s = s - (f.yt * f.x - f.xt * f.y) / determinant;
    next_t = t - (f.xs * f.y - f.ys * f.x) / determinant;
    const double beyond_s = std::max(cell.s - next_s, next_s - s1),
                 beyond_t = std::max(cell.t - next_t, next_t - t1);
    if (beyond_s > 0 && beyond_s >= beyond_t) {
      next_s = std::clamp(next_s, cell.s, s1);
      const double x = f.x + f.xs * (next_s - s), y = f.y + f.ys * (next_s - s);
      next_t = t - (x * f.xt + y * f.yt) / (f.xt * f.xt + f.yt * f.yt);
    } else if (beyond_t > 0) {
      next_t = std::clamp(next_t, cell.t, t1);
      const double x = f.x + f.xt * (next_t - t), y = f.y + f.yt * (next_t - t);
      next_s = s - (x * f.xs + y * f.ys) / (f.xs * f.xs + f.ys * f.ys);
    }
    next_s = std::clamp(next_s, cell.s, s1);
    next_t = std::clamp(next_t, cell.t, t1);
  }

  /// Newton's iteration, kept within the cell. Whether the ray passes within the tolerance of where
  /// it ends.
  bool solve(const Cell& cell, double& s, double& t) const {
    constexpr int kMostIterations = 24;
    double before = kFar;
    for (int i = 0; i < kMostIterations; ++i) {
      const Seen f = look(s, t);
      const double residual = f.x * f.x + f.y * f.y;
      double next_s, next_t;
      step(f, cell, s, t, next_s, next_t);
      const bool close = residual <= out_.tolerance * out_.tolerance;
      if (!(std::isfinite(next_s) && std::isfinite(next_t)) || (close && residual >= before)) {
        return close;
      }
      // Steps of 1e-8 leave an error of their square.
      const bool last = std::abs(next_s - s) + std::abs(next_t - t) < 1e-8;
      s = next_s;
      t = next_t;
      before = residual;
      if (last) {
        const Seen end = look(s, t);
        return end.x * end.x + end.y * end.y <= out_.tolerance * out_.tolerance;
      }
    }
    return false;
  }

  /// Of the angle between the ray and the surface; 0 where the tangents are parallel.
  double sineAt(double s, double t) const {
    BezierPatch::Values at;
    patch_.evaluate<1>(s, t, at);
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
    const double length = normal.norm();
    return length > 0 ? std::abs(normal.dot(ray_.direction)) / length : 0;
  }

  /// Whether the ray touches the surface in the cell without crossing it, or runs within it.
  ///
  /// Then cells around that place cannot be told from it by their hulls.
  bool touchesIn(const Cell& cell) {
    double s = cell.s + cell.size / 2, t = cell.t + cell.size / 2;
    if (!isThin(cell, look(s, t)) || !approach(cell, s, t)) {
      return false;
    }
    touch(s, t, along(s, t));
    for (int side = 0; side < 4; ++side) {
      touchSide(cell, side);
    }
    return true;
  }

  /// Whether all of the cell is as near as matters to a plane through the ray, tangent in `middle`.
  bool isThin(const Cell& cell, const Seen& middle) const {
    const bool along_s = std::hypot(middle.xs, middle.ys) > std::hypot(middle.xt, middle.yt);
    double nx = along_s ? -middle.ys : -middle.yt, ny = along_s ? middle.xs : middle.xt;
    const double length = std::hypot(nx, ny);
    if (!(length > 0)) {
      return false;
    }
    nx /= length;
    ny /= length;
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) {
        if (std::abs(nx * cell.x.at(i, j) + ny * cell.y.at(i, j)) > kThin * out_.tolerance) {
          return false;
        }
      }
    }
    return true;
  }

  /// In tolerances: up to here a ray that goes in and out again only touches (kSearchError).
  static constexpr double kThin = 10;

  /// A ray within the surface comes into the cell across one of its sides.
  void touchSide(const Cell& cell, int side) {
    const bool along_s = side < 2;
    const double low = along_s ? cell.s : cell.t, high = low + cell.size;
    double s = cell.s + (side == 3 ? cell.size : 0), t = cell.t + (side == 1 ? cell.size : 0);
    double& w = along_s ? s : t;
    w = low + cell.size / 2;
    for (int i = 0; i < kSideIterations; ++i) {
      const Seen f = look(s, t);
      const double dx = along_s ? f.xs : f.xt, dy = along_s ? f.ys : f.yt;
      const double squared = dx * dx + dy * dy;
      if (squared > 0) {
        w = std::clamp(w - (f.x * dx + f.y * dy) / squared, low, high);
      }
    }
    const Seen f = look(s, t);
    if (f.x * f.x + f.y * f.y <= out_.tolerance * out_.tolerance) {
      touch(s, t, along(s, t));
    }
  }

  static constexpr int kSideIterations = 6;

  /// Levenberg and Marquardt's iteration for the least distance from the ray, within the cell.
  /// Whether that is within the tolerance.
  bool approach(const Cell& cell, double& s, double& t) const {
    constexpr int kMostIterations = 40;
    const double enough = out_.tolerance * out_.tolerance;
    double damping = 1e-3;
    Seen f = look(s, t);
    double residual = f.x * f.x + f.y * f.y;
    for (int i = 0; i < kMostIterations && residual > enough; ++i) {
      const double gs = f.x * f.xs + f.y * f.ys, gt = f.x * f.xt + f.y * f.yt;
      const double ss = f.xs * f.xs + f.ys * f.ys, tt = f.xt * f.xt + f.yt * f.yt,
                   st = f.xs * f.xt + f.ys * f.yt;
      const double a = ss + damping * (ss + tt), b = tt + damping * (ss + tt);
      const double determinant = a * b - st * st;
      if (!(determinant > 0)) {
        return false;
      }
      const double next_s =
          std::clamp(s + (st * gt - b * gs) / determinant, cell.s, cell.s + cell.size);
      const double next_t =
          std::clamp(t + (st * gs - a * gt) / determinant, cell.t, cell.t + cell.size);
      const Seen next = look(next_s, next_t);
      const double next_residual = next.x * next.x + next.y * next.y;
      if (next_residual < residual) {
        s = next_s;
        t = next_t;
        f = next;
        residual = next_residual;
        damping = std::max(damping / 8, 1e-12);
      } else if (damping > 1e8 || (next_s == s && next_t == t)) {
        return false;
      } else {
        damping *= 8;
      }
    }
    return residual <= enough;
  }

  double along(double s, double t) const {
    double vs[4], vt[4], unused[3];
    bernstein(s, vs, unused);
    bernstein(t, vt, unused);
    double z = 0;
    for (int j = 0; j < 4; ++j) {
      const double* row = z_ + 4 * j;
      z += vt[j] * (vs[0] * row[0] + vs[1] * row[1] + vs[2] * row[2] + vs[3] * row[3]);
    }
    return z;
  }

  RayHit hitAt(double s, double t, double z) const {
    BezierPatch::Values at;
    patch_.evaluate<0>(s, t, at);
    return {z, patch_.on.at(s, t), (patch_.anchor + at.value).head<3>().matrix(),
            2 * out_.tolerance / std::max(sineAt(s, t), kLeastSine)};
  }

  bool counts(double z) const { return z >= out_.from - out_.tolerance && z <= out_.nearest; }

  void report(double s, double t) {
    const double z = along(s, t);
    if (counts(z)) {
      out_.add(hitAt(s, t, z));
    }
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  const BezierPatch& patch_;
  const RayFrame& ray_;
  CollectedHits& out_;
  double x_[16], y_[16], z_[16];                       // the whole patch as seen along the ray
  std::size_t within_ = static_cast<std::size_t>(-1);  // the hit that stands for a stretch
  int deep_cells_ = 0;
};

}  // namespace

void rayOnPatch(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out) {
  PatchRay(patch, ray, out).run();
}

}  // namespace limitsurf
