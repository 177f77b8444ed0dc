// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/ray_on_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/search/seen_patch.h"

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

/// A cell of the patch as the ray sees it.
struct Cell {
  ParameterSquare on;
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
      : patch_(patch), ray_(ray), seen_(patch, ray), out_(out) {}

  void run() { visit({{0, 0, 1}, 0, seen_.x, seen_.y, seen_.z}); }

 private:
  /// Cells in which a patch's second differences are below rounding.
  static constexpr int kMostDepth = 26;
  /// From here on a cell may be the place where the ray touches the patch.
  static constexpr int kTouchDepth = 2;
  /// Rays that stay within the tolerance of a patch for long are not followed any further.
  static constexpr int kDeep = 8, kMostDeepCells = 1 << 13;
  /// At smaller angles the ray runs within the surface: of that only the beginning is kept.
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

  /// All of the cell is as near to the ray as matters.
  void touchCorner(const Cell& cell) {
    for (int corner = 0; corner < 4; ++corner) {
      touch(cell.on.s + (corner & 1) * cell.on.size, cell.on.t + (corner >> 1) * cell.on.size);
    }
  }

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

  /// Whether the ray touches the surface in the cell without crossing it, or runs within it.
  ///
  /// Then cells around that place cannot be told from it by their hulls.
  bool touchesIn(const Cell& cell) {
    double s = cell.on.s + cell.on.size / 2, t = cell.on.t + cell.on.size / 2;
    if (!isThin(cell, seen_.aside(s, t)) || !seen_.approach(cell.on, out_.tolerance, s, t)) {
      return false;
    }
    touch(s, t);
    // A ray that runs within the surface comes into the cell across one of its sides.
    for (int side = 0; side < 4; ++side) {
      if (seen_.approachSide(cell.on, side, out_.tolerance, s, t)) {
        touch(s, t);
      }
    }
    return true;
  }

  /// Whether all of the cell is as near as matters to a plane through the ray, tangent in `middle`.
  bool isThin(const Cell& cell, const SeenPatch::Aside& middle) const {
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

  RayHit hitAt(double s, double t, double z) const {
    BezierPatch::Values at;
    patch_.evaluate<1>(s, t, at);
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
    const double length = normal.norm();
    return {z, patch_.on.at(s, t), (patch_.anchor + at.value).head<3>().matrix(),
            length > 0 ? std::abs(normal.dot(ray_.direction)) / length : 0};
  }

  bool counts(double z) const { return z >= out_.from - out_.tolerance && z <= out_.nearest; }

  void report(double s, double t) {
    const double z = seen_.along(s, t);
    if (counts(z)) {
      out_.add(hitAt(s, t, z));
    }
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  const BezierPatch& patch_;
  const RayFrame& ray_;
  SeenPatch seen_;
  CollectedHits& out_;
  std::size_t within_ = static_cast<std::size_t>(-1);  // the hit that stands for a stretch
  int deep_cells_ = 0;
};

}  // namespace

void rayOnPatch(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out) {
  PatchRay(patch, ray, out).run();
}

}  // namespace limitsurf
