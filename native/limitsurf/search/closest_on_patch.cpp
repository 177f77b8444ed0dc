// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/closest_on_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/search/foot_iteration.h"

namespace limitsurf {
namespace {

/// A square cell of a patch.
struct Cell : ParameterSquare {
  int depth;
};

class PatchSearch {
 public:
  PatchSearch(const BezierPatch& patch, const Vector3& point, const Facing* facing,
              ClosestSoFar& best)
      : patch_(patch), facing_(facing), best_(best) {
    const BezierPatch::Point offset =
        patch.anchor - BezierPatch::Point(point[0], point[1], point[2], 0);
    relative_.anchor.setZero();
    for (int i = 0; i < 16; ++i) {
      relative_.points[i] = patch.points[i] + offset;
    }
  }

  void run() {
    BezierPatch::Point low = relative_.points[0], high = low;
    for (int i = 1; i < 16; ++i) {
      low = low.min(relative_.points[i]);
      high = high.max(relative_.points[i]);
    }
    const BezierPatch::Point beyond = low.max(-high).max(0.);
    if (!isBetter(beyond.square().sum()) || isBehindFoot() || facesAway()) {
      return;
    }
    const SquaredDistance f(relative_.points);
    const double noise = noiseOf(f);
    if (isBetter(f.least() - noise)) {
      visit(f, noise, {{0, 0, 1}, 0});
    }
  }

 private:
  /// Cells so small that the distance over one varies by less than rounding.
  static constexpr int kMostDepth = 40;
  /// A patch so far from being one, as of no area, that its closest point cannot be told is not
  /// followed for ever.
  static constexpr int kMostCells = 1 << 17;
  /// Every so many halvings the squared distance is made anew.
  static constexpr int kFreshDepths = 4;
  static constexpr double kRounding = 1e-15;

  using Values = BezierPatch::Values;

  static double dot(const BezierPatch::Point& a, const BezierPatch::Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  bool isBetter(double squared_distance) const { return squared_distance < best_.enough(); }

  /// Whether the whole patch lies beyond the plane through the closest point so far, at right
  /// angles to the way there: the tightest bound on flat patches, and on those of no area.
  bool isBehindFoot() const {
    const double enough = best_.distance - best_.tolerance;
    const Vector3& n = best_.direction;
    for (const BezierPatch::Point& q : relative_.points) {
      if (n[0] * q[0] + n[1] * q[1] + n[2] * q[2] < enough) {
        return false;
      }
    }
    return true;
  }

  /// Whether no normal counts: where all products of tangents look away, sums of them do.
  bool facesAway() const {
    if (!facing_ || !(facing_->least_cosine > 0)) {
      return false;
    }
    bool any = false;
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        const BezierPatch::Point* p = patch_.points;
        const Vector3 ds = (p[4 * j + i + 1] - p[4 * j + i]).head<3>();
        const Vector3 across = facing_->direction.cross(ds);
        for (int x = 0; x < 4; ++x) {
          for (int y = 0; y < 3; ++y) {
            const BezierPatch::Point dt = p[4 * (y + 1) + x] - p[4 * y + x];
            const double towards = across[0] * dt[0] + across[1] * dt[1] + across[2] * dt[2];
            if (towards > 0) {
              return false;
            }
            any |= towards < 0 || (ds != Vector3::Zero() && (dt != 0).any());
          }
        }
      }
    }
    return any;
  }

  /// Whether the distance falls towards sides of the cell beyond which the sheet goes on: then no
  /// foot is in it.
  bool fallsOutwards(const Cell& cell, const SquaredDistance::Shape& shape) const {
    const unsigned borders = bordersOf(cell);
    return (shape.s_strictly && (borders & (shape.s_side < 0 ? kSideS0 : kSideS1)) == 0) ||
           (shape.t_strictly && (borders & (shape.t_side < 0 ? kSideT0 : kSideT1)) == 0);
  }

  /// The cell's sides at which the sheet ends.
  unsigned bordersOf(const Cell& cell) const {
    return patch_.borders &
           ((cell.s == 0 ? kSideS0 : 0u) | (cell.t == 0 ? kSideT0 : 0u) |
            (cell.s + cell.size == 1 ? kSideS1 : 0u) | (cell.t + cell.size == 1 ? kSideT1 : 0u));
  }

  /// What rounding may have done to the coefficients, and to those of its quarters.
  static double noiseOf(const SquaredDistance& f) { return kRounding * f.largest(); }

  /// The patch's control points on a cell, less the point.
  void pointsOf(const Cell& cell, BezierPatch::Point out[16]) const {
    std::copy(relative_.points, relative_.points + 16, out);
    for (int i = 0; i < 4; ++i) {
      bezier::cut(out + 4 * i, 1, cell.s, cell.s + cell.size);
    }
    for (int i = 0; i < 4; ++i) {
      bezier::cut(out + i, 4, cell.t, cell.t + cell.size);
    }
  }

  void visit(const SquaredDistance& f, double noise, const Cell& cell) {
    const double reach = std::max(best_.tolerance, std::sqrt(std::max(0., f.least())));
    const double least_slack = reach * best_.tolerance;
    const double slack = noise <= 4 * least_slack ? 5 * least_slack : least_slack;
    const SquaredDistance::Shape shape = f.shape(slack);
    if (facing_ && (fallsOutwards(cell, shape) ||
                    (!shape.convex && bordersOf(cell) == 0 && f.isNowhereConvex()))) {
      return;
    }
    double s, t;
    f.guess(s, t);
    s = cell.s + sideOr(shape.s_side, s) * cell.size;
    t = cell.t + sideOr(shape.t_side, t) * cell.size;
    const bool corner = shape.s_side != 0 && shape.t_side != 0;
    if (cell.depth == kMostDepth || ++cells_ > kMostCells || corner ||
        (shape.convex && minimizeDistance(relative_, cell, slack, s, t))) {
      if (!facing_ || isFoot(cell, s, t)) {
        offer(s, t);
      }
      return;
    }
    if (!facing_) {
      for (int i = 0; i < 4; ++i) {
        const double squared = f.corner(i & 1, i >> 1);
        if (isBetter(squared)) {
          offer(cell.s + (i & 1) * cell.size, cell.t + (i >> 1) * cell.size);
        }
      }
    }
    SquaredDistance quarters[4];
    f.quarter(quarters);
    double least[4];
    for (int q = 0; q < 4; ++q) {
      least[q] = quarters[q].least();
    }
    const double half = cell.size / 2;
    for (const int q : ascending(least)) {
      if (!isBetter(least[q] - noise) || isBehindFoot()) {
        continue;
      }
      const Cell next{{cell.s + (q & 1) * half, cell.t + (q >> 1) * half, half}, cell.depth + 1};
      if (next.depth % kFreshDepths == 0) {
        // Quarters inherit the rounding of the whole: those of the points are as small as they.
        BezierPatch::Point points[16];
        pointsOf(next, points);
        const SquaredDistance fresh(points);
        visit(fresh, noiseOf(fresh), next);
      } else {
        visit(quarters[q], noise, next);
      }
    }
  }

  static double sideOr(int side, double other) { return side < 0 ? 0 : side > 0 ? 1 : other; }

  void offer(double s, double t) {
    Values at;
    relative_.evaluate<0>(s, t, at);
    best_.offer(at.value.head<3>().matrix(), patch_.on.at(s, t));
  }

  /// Whether the minimum over a convex cell is one over the smooth sheet around it as well, with a
  /// normal that counts. On a side of the cell beyond which the sheet goes on, the distance must
  /// not fall across it.
  bool isFoot(const Cell& cell, double s, double t) const {
    // The patch's own points give tangents all their digits, however far away the point is.
    Values at, to_foot;
    patch_.evaluate<1>(s, t, at);
    relative_.evaluate<0>(s, t, to_foot);
    const double value = std::sqrt(dot(to_foot.value, to_foot.value));
    const auto falls = [&](const BezierPatch::Point& tangent, double outwards) {
      const double slope = outwards * dot(to_foot.value, tangent);
      return slope < -kFlat * (value * std::sqrt(dot(tangent, tangent)));
    };
    const double s1 = cell.s + cell.size, t1 = cell.t + cell.size;
    const unsigned borders = bordersOf(cell);
    if ((s == cell.s && !(borders & kSideS0) && falls(at.ds, -1)) ||
        (s == s1 && !(borders & kSideS1) && falls(at.ds, 1)) ||
        (t == cell.t && !(borders & kSideT0) && falls(at.dt, -1)) ||
        (t == t1 && !(borders & kSideT1) && falls(at.dt, 1))) {
      return false;
    }
    // Patches keep the orientation of their face, turned by right angles.
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
    return normal.norm() > kParallel * ds.norm() * dt.norm() ? facing_->accepts(normal)
                                                             : facing_->accepts(patch_.on.at(s, t));
  }

  /// The sine of an angle that rounding may bring about.
  static constexpr double kFlat = 1e-9;
  /// The sine of an angle between tangents below which rounding may turn the normal.
  static constexpr double kParallel = 1e-3;

  const BezierPatch& patch_;
  const Facing* facing_;
  ClosestSoFar& best_;
  BezierPatch relative_;
  int cells_ = 0;
};

}  // namespace

void closestOnPatch(const BezierPatch& patch, const Vector3& point, const Facing* facing,
                    ClosestSoFar& best) {
  PatchSearch(patch, point, facing, best).run();
}

}  // namespace limitsurf
