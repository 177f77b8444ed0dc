// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/patch_intersection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/search/rays/patch_in_ray_frame.h"

namespace limitsurf {

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

/// A dyadic square of the patch's parameters, in the frame of the ray.
struct Cell {
  ParameterSquare on;
  int depth;
  Cubic x, y;  ///< across the ray
  Cubic z;     ///< along the ray
};

/// The mean derivatives of a patch on a cell, from the differences of its corners. Their inverse is
/// the preconditioner.
struct Precondition {
  explicit Precondition(const Cell& cell) {
    xs = mean(cell.x, true);
    xt = mean(cell.x, false);
    ys = mean(cell.y, true);
    yt = mean(cell.y, false);
    determinant = xs * yt - xt * ys;
    scale = std::sqrt((xs * xs + ys * ys) * (xt * xt + yt * yt));
  }

  /// The derivatives are linearly dependent if the sine of their angle is at most kSingularSine.
  bool isSingular() const { return !(std::abs(determinant) > kSingularSine * scale); }
  static constexpr double kSingularSine = 1e-9;

  static double mean(const Cubic& f, bool along_s) {
    return along_s ? ((f.at(3, 0) - f.at(0, 0)) + (f.at(3, 3) - f.at(0, 3))) / 2
                   : ((f.at(0, 3) - f.at(0, 0)) + (f.at(3, 3) - f.at(3, 0))) / 2;
  }

  double xs, xt, ys, yt, determinant, scale;
};

/// The search for the points at which a ray meets one patch.
class PatchIntersection {
 public:
  PatchIntersection(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out)
      : patch_(patch), ray_(ray), seen_(patch, ray), out_(out) {}

  void run() { visit({{0, 0, 1}, 0, seen_.x, seen_.y, seen_.z}); }

 private:
  /// At this depth the second differences of a patch are below rounding.
  static constexpr int kMostDepth = 26;
  /// Cells at this depth and below are tested for a point at which the ray touches the patch.
  static constexpr int kTouchDepth = 2;
  /// The search ends after kMostDeepCells cells at depth kDeep and below: the ray then stays close
  /// to the patch over a long way.
  static constexpr int kDeep = 8, kMostDeepCells = 1 << 13;
  /// If the sine of the angle is smaller, the ray runs within the surface, and only the beginning
  /// of that stretch is kept.
  static constexpr double kWithinSine = 1e-9;

  static bool isWithin(const Cubic& f, double margin) {
    return f.least() >= -margin && f.largest() <= margin;
  }

  static bool misses(const Cubic& f, double margin) {
    return f.least() > margin || f.largest() < -margin;
  }

  bool isBeyond(const Cell& cell) const {
    return cell.z.least() > out_.nearest || cell.z.largest() < out_.from - out_.tolerance;
  }

  /// Searches a cell.
  void visit(const Cell& cell) {
    if (misses(cell.x, out_.margin()) || misses(cell.y, out_.margin()) || isBeyond(cell)) {
      return;
    }
    if (isWithin(cell.x, out_.tolerance) && isWithin(cell.y, out_.tolerance)) {
      touchCorners(cell);
      touchBeginning(cell.on);
      return;
    }
    const Precondition p(cell);
    if (!p.isSingular()) {
      // The preconditioned coordinates are nearly s - s0 and t - t0, with the hit at (s0, t0).
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
        double s = cell.on.s + cell.on.size / 2, t = cell.on.t + cell.on.size / 2;
        if (seen_.cross(cell.on, out_.tolerance, s, t)) {
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

  /// Takes the corners of a cell that lies within the tolerance of the ray.
  void touchCorners(const Cell& cell) {
    for (int corner = 0; corner < 4; ++corner) {
      touch(cell.on.s + (corner & 1) * cell.on.size, cell.on.t + (corner >> 1) * cell.on.size);
    }
  }

  /// Takes a point at which the ray touches the patch, or at which a stretch within it begins.
  void touch(double s, double t) {
    const double z = seen_.along(s, t);
    if (!counts(z)) {
      return;
    }
    const RayHit hit = hitAt(s, t, z);
    if (out_.first_only || hit.sine > kWithinSine) {
      out_.add(hit);
    } else if (within_ >= out_.hits.size()) {
      within_ = out_.hits.size();
      out_.add(hit);
    } else if (z < out_.hits[within_].distance) {
      out_.hits[within_] = hit;
    }
  }

  /// Takes the beginning of the ray if it lies on a square of the patch. Where the ray runs within
  /// the patch or along a tangent, the points at which it touches or crosses it may be behind its
  /// beginning.
  void touchBeginning(const ParameterSquare& on) {
    touchBeginning(on, on.s + on.size / 2, on.t + on.size / 2);
  }
  /// The same, from (s, t) on. Returns whether the ray begins there.
  bool touchBeginning(const ParameterSquare& on, double s, double t) {
    const bool begins = seen_.approachPoint(on, out_.from, out_.tolerance, s, t);
    if (begins) {
      touch(s, t);
    }
    return begins;
  }

  /// Searches the quarters of a cell, those that begin nearer first.
  void divide(const Cell& cell) {
    Cubic x[4], y[4], z[4];
    cell.x.quarter(x);
    cell.y.quarter(y);
    cell.z.quarter(z);
    double near[4];
    for (int q = 0; q < 4; ++q) {
      near[q] = z[q].least();
    }
    const double half = cell.on.size / 2;
    for (const int q : ascending(near)) {
      const ParameterSquare on{cell.on.s + (q & 1) * half, cell.on.t + (q >> 1) * half, half};
      visit({on, cell.depth + 1, x[q], y[q], z[q]});
    }
  }

  /// Whether the ray sees no two points of the cell at the same place: the preconditioned
  /// derivatives form a matrix that is diagonally dominant on the whole cell.
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

  /// Whether the ray touches the surface in the cell without crossing it, or runs within it, so
  /// that control hulls cannot separate the cells around that point from the ray. Takes the point.
  bool touchesIn(const Cell& cell) {
    double s = cell.on.s + cell.on.size / 2, t = cell.on.t + cell.on.size / 2;
    if (!isThin(cell, seen_.aside(s, t))) {
      return false;
    }
    touchBeginning(cell.on);
    if (!seen_.approach(cell.on, out_.tolerance, s, t)) {
      return false;
    }
    touch(s, t);
    // A ray that runs within the surface enters the cell across one of its sides.
    for (int side = 0; side < 4; ++side) {
      if (seen_.approachSide(cell.on, side, out_.tolerance, s, t)) {
        touch(s, t);
      }
    }
    return true;
  }

  /// Whether the whole cell lies within kThin tolerances of the plane through the ray that is
  /// tangent to the patch in the middle.
  bool isThin(const Cell& cell, const PatchInRayFrame::Aside& middle) const {
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

  /// In tolerances: within this distance, kSearchError, a ray that enters and leaves the surface
  /// again only touches it.
  static constexpr double kThin = 10;

  /// The hit at (s, t), at the distance z along the ray.
  RayHit hitAt(double s, double t, double z) const {
    BezierPatch::Values at;
    patch_.evaluate<1>(s, t, at);
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
    const double length = normal.norm();
    return {z, patch_.on.at(s, t), (patch_.anchor + at.value).head<3>().matrix(),
            length > 0 ? std::abs(normal.dot(ray_.direction)) / length : 0};
  }

  /// Whether the ray reaches the distance z.
  bool counts(double z) const { return z >= out_.from - out_.tolerance && z <= out_.nearest; }

  /// Takes the point at which the ray crosses the patch. If it is as near to the beginning of the
  /// ray as the patch may stay near the ray, the ray may begin on the patch: then that is taken.
  void report(double s, double t) {
    constexpr double kNear = 4;
    const double z = seen_.along(s, t);
    const RayHit hit = hitAt(s, t, z);
    if (std::abs(z - out_.from) <= kNear * hit.slack(out_.tolerance) &&
        touchBeginning({0, 0, 1}, s, t)) {
      return;
    }
    if (counts(z)) {
      out_.add(hit);
    }
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  const BezierPatch& patch_;
  const RayFrame& ray_;
  PatchInRayFrame seen_;
  CollectedHits& out_;
  std::size_t within_ = static_cast<std::size_t>(-1);  // the hit kept for a stretch within
  int deep_cells_ = 0;
};

}  // namespace

void intersectPatch(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out) {
  PatchIntersection(patch, ray, out).run();
}

}  // namespace limitsurf
