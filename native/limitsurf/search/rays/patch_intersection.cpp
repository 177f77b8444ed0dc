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
  ParameterRectangle on;
  int depth;
  Cubic x, y;  ///< across the ray
  Cubic z;     ///< along the ray
};

/// The search for the points at which a ray meets one patch.
class PatchIntersection {
 public:
  PatchIntersection(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out)
      : patch_(patch), ray_(ray), seen_(patch, ray), out_(out) {}

  void run() { visit({{0, 0, 1, 1}, 0, seen_.x, seen_.y, seen_.z}); }

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

  /// Searches a cell.
  void visit(const Cell& cell) {
    ++out_.cells;
    const RayLimits limits{out_.from - out_.tolerance, out_.nearest, out_.margin(), out_.tolerance};
    switch (seen_.meet(cell.x, cell.y, cell.z, limits)) {
      case RayMeeting::none:
        return;
      case RayMeeting::everywhere:
        touchCorners(cell);
        touchBeginning(cell.on);
        return;
      case RayMeeting::once_at_most: {
        double s = cell.on.s + cell.on.s_size / 2, t = cell.on.t + cell.on.t_size / 2;
        if (seen_.cross(cell.on, out_.tolerance, s, t)) {
          report(s, t);
          return;
        }
        break;
      }
      case RayMeeting::unknown:
        break;
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
      touch(cell.on.s + (corner & 1) * cell.on.s_size, cell.on.t + (corner >> 1) * cell.on.t_size);
    }
  }

  /// Takes a point at which the ray touches the patch, or at which a stretch within it begins.
  void touch(double s, double t) {
    const double z = seen_.place(s, t).z;
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

  /// Takes the beginning of the ray if it lies on a rectangle of the patch. Where the ray runs
  /// within the patch or along a tangent, the points at which it touches or crosses it may be
  /// behind its beginning.
  void touchBeginning(const ParameterRectangle& on) {
    touchBeginning(on, on.s + on.s_size / 2, on.t + on.t_size / 2);
  }
  /// The same, from (s, t) on. Returns whether the ray begins there.
  bool touchBeginning(const ParameterRectangle& on, double s, double t) {
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
    const double s_half = cell.on.s_size / 2, t_half = cell.on.t_size / 2;
    for (const int q : ascending(near)) {
      const ParameterRectangle on{cell.on.s + (q & 1) * s_half, cell.on.t + (q >> 1) * t_half,
                                  s_half, t_half};
      visit({on, cell.depth + 1, x[q], y[q], z[q]});
    }
  }

  /// Whether the ray touches the surface in the cell without crossing it, or runs within it, so
  /// that control hulls cannot separate the cells around that point from the ray. Takes the point.
  bool touchesIn(const Cell& cell) {
    double s = cell.on.s + cell.on.s_size / 2, t = cell.on.t + cell.on.t_size / 2;
    if (!isThin(cell, seen_.offset(s, t))) {
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
  bool isThin(const Cell& cell, const OffsetFromRay& middle) const {
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
    if (out_.first_only) {
      return {z, patch_.on.at(s, t)};
    }
    BezierPatch::Values at;
    patch_.evaluate<1>(s, t, at);
    return {z, patch_.on.at(s, t), (patch_.anchor + at.value).head<3>().matrix(), sineOf(at)};
  }

  /// The sine of the angle between the ray and the patch.
  double sineOf(const BezierPatch::Values& at) const {
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
    const double length = normal.norm();
    return length > 0 ? std::abs(normal.dot(ray_.direction)) / length : 0;
  }

  /// Whether the ray reaches the distance z.
  bool counts(double z) const { return z >= out_.from - out_.tolerance && z <= out_.nearest; }

  /// Takes the point at which the ray crosses the patch. If it is as near to the beginning of the
  /// ray as the patch may stay near the ray, the ray may begin on the patch: then that is taken.
  void report(double s, double t) {
    const double z = seen_.place(s, t).z;
    if (mayBeginAt(s, t, z) && touchBeginning({0, 0, 1, 1}, s, t)) {
      return;
    }
    if (counts(z)) {
      out_.add(hitAt(s, t, z));
    }
  }

  bool mayBeginAt(double s, double t, double z) const {
    constexpr double kNear = 4;
    const double away = std::abs(z - out_.from);
    if (away > kNear * RayHit::slack(0, out_.tolerance)) {  // at any angle
      return false;
    }
    BezierPatch::Values at;
    patch_.evaluate<1>(s, t, at);
    return away <= kNear * RayHit::slack(sineOf(at), out_.tolerance);
  }

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
