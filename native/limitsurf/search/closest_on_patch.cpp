// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/closest_on_patch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limitsurf/search/foot_iteration.h"
#include "limitsurf/search/normals/local_minimum.h"
#include "limitsurf/search/normals/normal_polynomial.h"
#include "limitsurf/search/patch_sides.h"
#include "limitsurf/search/squared_distance.h"

namespace limitsurf {
namespace {

/// A dyadic rectangle of the patch's parameters.
struct Cell : ParameterRectangle {
  int depth;
};

/// The search for the closest point of one patch.
class PatchSearch {
 public:
  PatchSearch(const BezierPatch& patch, const Facing* facing, ClosestSoFar& best)
      : patch_(patch), facing_(facing), best_(best), away_(best.from.paddedAway()) {
    const Vector3& place = best.from.place;
    const BezierPatch::Point offset =
        patch.anchor - BezierPatch::Point(place[0], place[1], place[2], 0);
    relative_.anchor.setZero();
    least_ = kernels_.move(numbersOf(patch.points), offset.data(), away_.data(),
                           numbersOf(relative_.points));
  }

  void run(const FootBound& bound) {
    if (!isBetter(least_) || isBehindFoot() || (facing_ && facing_->excludes(patch_))) {
      return;
    }
    if ((facing_ || isBoundUseful(bound)) && findsFoot(bound)) {
      return;
    }
    if (isPoint()) {
      if (!facing_ || isFoot(0, 0)) {
        offer(0, 0);
      }
      return;
    }
    const SquaredDistance f(kernels_, relative_.points, away_);
    const double noise = noiseOf(f);
    if (isBetter(f.least() - noise)) {
      visit(f, noise, {{0, 0, 1, 1}, 0});
      best_.cells += cells_;
    }
  }

 private:
  /// No squared distance is large enough to end an iteration early.
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  /// Over a cell as small as this the distance varies by less than rounding.
  static constexpr double kLeastSize = 0x1p-40;
  /// Cells are divided along one parameter alone if second differences along it are this many times
  /// those along the other one: where a patch is long and thin.
  static constexpr double kLong = 4;
  /// A search ends after this many cells: on patches without area many points may be equally close
  /// but for rounding.
  static constexpr int kMostCells = 1 << 17;
  /// After this many cells, and from the first one on if the patch is narrow, the normals of the
  /// patch are bounded, to leave out cells without feet: if the tangents are nearly parallel, the
  /// squared distance is convex in a narrow band only.
  static constexpr int kFewCells = 16;
  /// After this many cells each is compared with a plane of its own (isAside()), and a minimum is
  /// looked for in each: along a curve of places that are almost equally close, the corners of
  /// cells are no good guesses. A narrow patch is compared with a plane as a whole, too.
  static constexpr int kManyCells = 64;
  /// Patches whose width is at most this part of their length count as narrow.
  static constexpr double kNarrow = 1. / 32;
  /// The squared distance is computed anew after every so many divisions.
  static constexpr int kFreshDepths = 4;
  /// The rounding of a cell's points and of their distance from a plane, relative to the largest
  /// coordinate: a dozen units in the last place.
  static constexpr double kPlaneRounding = 0x1p-48;
  /// The relative rounding of the squared distance's coefficients: a few units in the last place.
  static constexpr double kRounding = 1e-15;

  using Values = BezierPatch::Values;

  /// Beyond so many radii FootBound::holds() seldom does.
  static constexpr double kUsefulRadii = 2;
  bool isBoundUseful(const FootBound& bound) const {
    const double reach = kUsefulRadii * double{bound.radius} + best_.from.range;
    return bound.stretch > 0 && least_ + best_.from.range * best_.from.range < reach * reach;
  }

  /// Looks for the closest point of the whole patch by first-order conditions. Returns whether it
  /// is found or cannot matter, for certain.
  bool findsFoot(const FootBound& bound) {
    double s, t;
    guess(s, t);
    const double range = best_.from.range;
    const double reach = std::max(best_.tolerance, std::sqrt(std::max(0., least_ + range * range)));
    BezierPatch::Point found;
    const FootSearch search =
        minimizeDistance(kernels_, relative_, away_, {0, 0, 1, 1}, reach * best_.tolerance,
                         best_.enough(), bound.radius, s, t, found);
    if (search == FootSearch::beyond) {
      return true;
    }
    if (facing_ && !(search == FootSearch::arrived && isFoot(s, t))) {
      return false;
    }
    offer(found, s, t);
    if (search != FootSearch::arrived) {
      return false;
    }
    const BezierPatch::Point way = found - away_;
    const double distance = std::sqrt(dot(way, way));
    if (distance <= bound.radius) {
      return true;
    }
    const BezierPatch::Point direction = way / distance;
    double z[16];
    kernels_.along(numbersOf(relative_.points), direction.data(), z);
    return bound.holds(z, distance);
  }

  /// Whether the whole patch is in one place. On a mesh without extent, where the tolerance is 0,
  /// the cells of such a patch would be divided in vain: all are equally close but for rounding.
  bool isPoint() const {
    return std::all_of(patch_.points + 1, patch_.points + 16, [&](const BezierPatch::Point& point) {
      return (point == patch_.points[0]).all();
    });
  }

  /// The closest point of the plane of the patch's mean derivatives.
  void guess(double& s, double& t) const {
    const BezierPatch::Point* p = relative_.points;
    const BezierPatch::Point low = p[3] - p[0], high = p[15] - p[12];
    const BezierPatch::Point along = 0.5 * (low + high),
                             across = (p[12] - p[0]) + 0.5 * (high - low);
    const BezierPatch::Point middle = 0.25 * ((p[0] + p[3]) + (p[12] + p[15])) - away_;
    const double ss = dot(along, along), tt = dot(across, across), st = dot(along, across);
    const double gs = dot(middle, along), gt = dot(middle, across);
    const double determinant = ss * tt - st * st;
    s = determinant > 0 ? std::clamp(0.5 + (st * gt - tt * gs) / determinant, 0., 1.) : 0.5;
    t = determinant > 0 ? std::clamp(0.5 + (st * gs - ss * gt) / determinant, 0., 1.) : 0.5;
  }

  bool isBetter(double squared_distance) const { return squared_distance < best_.enough(); }

  /// Whether the whole patch lies beyond the plane through the closest point so far, perpendicular
  /// to the direction of that point. This is the tightest bound for flat patches and for those of
  /// no area.
  bool isBehindFoot() const {
    const double enough = best_.plane - best_.tolerance;
    const Vector3& n = best_.direction;
    for (const BezierPatch::Point& q : relative_.points) {
      if (n[0] * q[0] + n[1] * q[1] + n[2] * q[2] < enough) {
        return false;
      }
    }
    return true;
  }

  /// Whether the distance falls towards a side of the cell beyond which the sheet continues: then
  /// no foot is in the cell.
  bool fallsOutwards(const Cell& cell, const SquaredDistance::Shape& shape) const {
    const unsigned borders = bordersOf(cell);
    return (shape.s_strictly && (borders & (shape.s_side < 0 ? kSideS0 : kSideS1)) == 0) ||
           (shape.t_strictly && (borders & (shape.t_side < 0 ? kSideT0 : kSideT1)) == 0);
  }

  /// Whether the patch is much longer than wide. Both of its parameters may lead along it.
  bool isNarrow() {
    if (!is_narrow_) {
      const BezierPatch::Point s = sidesAlongS(relative_.points), t = sidesAlongT(relative_.points);
      const double ss = dot(s, s), tt = dot(t, t), st = dot(s, t), longer = std::max(ss, tt);
      is_narrow_ = ss * tt - st * st < kNarrow * kNarrow * longer * longer;
    }
    return *is_narrow_;
  }

  /// Whether the sheet ends at no side of the cell, or the distance falls along each such side
  /// towards a corner beyond which the sheet continues: then no foot is on these sides.
  bool hasNoFootOnBorders(const SquaredDistance& f, const Cell& cell) const {
    const unsigned borders = bordersOf(cell);
    for (const unsigned side : {kSideS0, kSideS1, kSideT0, kSideT1}) {
      if (borders & side) {
        const int slope = f.slopeAlong(side);
        const unsigned ends = side & (kSideS0 | kSideS1) ? (slope < 0 ? kSideT1 : kSideT0)
                                                         : (slope < 0 ? kSideS1 : kSideS0);
        if (slope == 0 || (borders & ends)) {
          return false;
        }
      }
    }
    return true;
  }

  /// Whether the cell has no foot for certain: neither on its smooth part nor on a side where the
  /// sheet ends. The closest point of a surface is a foot.
  bool hasNoFootOfSheet(const SquaredDistance& f, const Cell& cell) {
    if (!hasNoFootOnBorders(f, cell)) {
      return false;
    }
    if (!normals_) {
      normals_.emplace(patch_, best_.tolerance / 10);
    }
    BezierPatch::Point points[16];
    pointsOf(cell, points);
    for (BezierPatch::Point& point : points) {
      point -= away_;
    }
    return normals_->hasNoFoot(cell, points, best_.tolerance);
  }

  /// Whether a plane beside the searching point, no nearer to it than the closest point so far, has
  /// the whole cell on its other side.
  ///
  /// A patch that is squeezed to nearly a line crosses the plane perpendicular to the line along a
  /// long curve of its parameters. The squared distances at the control points of a cell beside
  /// that curve are large along the line and say nothing about the small distance across, for which
  /// the cell would be divided until it is as short as the patch is narrow. The plane is parallel
  /// to the line, so only what is across counts.
  bool isAside(const Cell& cell) const {
    if (best_.from.isFar()) {
      return false;
    }
    double largest = 0;
    for (const BezierPatch::Point& point : relative_.points) {
      largest = std::max(largest, point.abs().maxCoeff());
    }
    const double enough = best_.excess - best_.tolerance + kPlaneRounding * largest;
    BezierPatch::Point p[16];
    pointsOf(cell, p);
    const BezierPatch::Point one = p[15] - p[0], other = p[12] - p[3];
    const BezierPatch::Point line = dot(one, one) > dot(other, other) ? one : other;
    const BezierPatch::Point middle = 0.25 * ((p[0] + p[3]) + (p[12] + p[15]));
    const double square = dot(line, line);
    BezierPatch::Point across = middle;
    // The first time leaves the rounding of the middle, which may be a large part of what is across
    // and point along the line; the second time removes that.
    for (int times = 0; times < 2 && square > 0; ++times) {
      across -= (dot(across, line) / square) * line;
    }
    const double length = std::sqrt(dot(across, across));
    return length > enough && std::all_of(p, p + 16, [&](const BezierPatch::Point& point) {
             return dot(point, across) >= enough * length;
           });
  }

  /// The sides of the cell at which the sheet ends, as bits.
  unsigned bordersOf(const Cell& cell) const {
    return patch_.borders & ((cell.s == 0 ? kSideS0 : 0u) | (cell.t == 0 ? kSideT0 : 0u) |
                             (cell.s + cell.s_size == 1 ? kSideS1 : 0u) |
                             (cell.t + cell.t_size == 1 ? kSideT1 : 0u));
  }

  /// Bound on the rounding of the coefficients, and of those of the parts.
  static double noiseOf(const SquaredDistance& f) { return kRounding * f.magnitude(); }

  /// The control points of the patch on a cell, relative to the searching point.
  void pointsOf(const Cell& cell, BezierPatch::Point out[16]) const {
    std::copy(relative_.points, relative_.points + 16, out);
    for (int i = 0; i < 4 && cell.s_size < 1; ++i) {
      bezier::cut(out + 4 * i, 1, cell.s, cell.s + cell.s_size);
    }
    for (int i = 0; i < 4 && cell.t_size < 1; ++i) {
      bezier::cut(out + i, 4, cell.t, cell.t + cell.t_size);
    }
  }

  /// Searches a cell: finds the minimum on it if the squared distance is convex there, else divides
  /// the cell.
  void visit(const SquaredDistance& f, double noise, const Cell& cell) {
    const double range = best_.from.range;
    const double reach =
        std::max(best_.tolerance, std::sqrt(std::max(0., f.least() + range * range)));
    const double least_slack = reach * best_.tolerance;
    const double slack = noise <= 4 * least_slack ? 5 * least_slack : least_slack;
    const SquaredDistance::Shape shape = f.shape(slack);
    if (facing_ && (fallsOutwards(cell, shape) ||
                    (!shape.convex && bordersOf(cell) == 0 && f.isNowhereConvex()))) {
      return;
    }
    double s, t;
    BezierPatch::Point found;
    f.guess(s, t);
    s = cell.s + sideOr(shape.s_side, s) * cell.s_size;
    t = cell.t + sideOr(shape.t_side, t) * cell.t_size;
    const bool corner = shape.s_side != 0 && shape.t_side != 0;
    bool done = std::max(cell.s_size, cell.t_size) <= kLeastSize || ++cells_ > kMostCells || corner;
    if (!done && shape.convex) {
      const FootSearch search = minimizeDistance(kernels_, relative_, away_, cell, slack,
                                                 best_.enough() + noise, kNever, s, t, found);
      if (search == FootSearch::beyond) {
        return;
      }
      done = search == FootSearch::arrived;
      if (done && !facing_) {
        offer(found, s, t);
        return;
      }
    }
    if (done) {
      if (facing_) {
        // Over a small cell the distance may vary by less than `slack` although it falls.
        minimizeDistance(kernels_, relative_, away_, cell, 0, kNever, kNever, s, t, found);
        if (!isFoot(s, t)) {
          return;
        }
      }
      offer(s, t);
      return;
    }
    if (facing_ && cells_ > kFewCells && isLine()) {
      return;
    }
    const bool tests_feet = cells_ > kFewCells || isNarrow();
    if ((tests_feet && cell.depth > 0 && hasNoFootOfSheet(f, cell)) ||
        ((cells_ > kManyCells || (cell.depth == 0 && isNarrow())) && isAside(cell))) {
      return;
    }
    if (!facing_) {
      if (cell.depth == 0 || cells_ > kManyCells) {
        // A minimum that may be none of the whole patch is a guess that leaves out most cells.
        minimizeDistance(kernels_, relative_, away_, cell, slack, kNever, kNever, s, t, found);
        offer(found, s, t);
      }
      for (int i = 0; i < 4; ++i) {
        const double squared = f.corner(i & 1, i >> 1);
        if (isBetter(squared)) {
          offer(cell.s + (i & 1) * cell.s_size, cell.t + (i >> 1) * cell.t_size);
        }
      }
    }
    // A patch without a foot offers a place as well: otherwise searches would pass many such
    // patches until they come to the one that has the foot.
    if (tests_feet && cell.depth == 0 && hasNoFootOfSheet(f, cell)) {
      return;
    }
    visitParts(f, noise, cell, divisionOf(cell, shape));
  }

  static SquaredDistance::Division divisionOf(const Cell& cell,
                                              const SquaredDistance::Shape& shape) {
    using Division = SquaredDistance::Division;
    if (cell.t_size <= kLeastSize ||
        (cell.s_size > kLeastSize && shape.s_bend > kLong * shape.t_bend)) {
      return Division::s;
    }
    if (cell.s_size <= kLeastSize || shape.t_bend > kLong * shape.s_bend) {
      return Division::t;
    }
    return Division::both;
  }

  /// Searches the parts of a cell, nearer ones first.
  void visitParts(const SquaredDistance& f, double noise, const Cell& cell,
                  SquaredDistance::Division along) {
    SquaredDistance parts[4];
    f.divide(along, parts);
    const double s_size = along == SquaredDistance::Division::t ? cell.s_size : cell.s_size / 2;
    const double t_size = along == SquaredDistance::Division::s ? cell.t_size : cell.t_size / 2;
    double least[4];
    for (int q = 0; q < 4; ++q) {
      const bool is_part =
          ((q & 1) == 0 || s_size < cell.s_size) && ((q >> 1) == 0 || t_size < cell.t_size);
      least[q] = is_part ? parts[q].least() : std::numeric_limits<double>::infinity();
    }
    for (const int q : ascending(least)) {
      if (!isBetter(least[q] - noise) || isBehindFoot()) {
        continue;
      }
      const Cell next{{cell.s + (q & 1) * s_size, cell.t + (q >> 1) * t_size, s_size, t_size},
                      cell.depth + 1};
      if (next.depth % kFreshDepths == 0) {
        // Parts inherit the rounding of the whole; points computed for the cell have less.
        BezierPatch::Point points[16];
        pointsOf(next, points);
        const SquaredDistance fresh(kernels_, points, away_);
        visit(fresh, noiseOf(fresh), next);
      } else {
        visit(parts[q], noise, next);
      }
    }
  }

  /// Whether no normal of the patch can meet the condition since it has none.
  bool isLine() {
    if (!is_line_) {
      is_line_ = facing_->excludesLine(patch_);
    }
    return *is_line_;
  }

  static double sideOr(int side, double other) { return side < 0 ? 0 : side > 0 ? 1 : other; }

  void offer(double s, double t) {
    Values at;
    relative_.evaluate<0>(s, t, at);
    offer(at.value, s, t);
  }
  void offer(const BezierPatch::Point& found, double s, double t) {
    best_.offer(found.head<3>().matrix(), patch_.on.at(s, t));
  }

  /// Whether a place of the patch is a foot: a local minimum of the distance with a normal that
  /// meets the condition.
  bool isFoot(double s, double t) const {
    // Tangents are computed from the patch's own points, so that they keep all their digits however
    // far away the searching point is.
    SheetPlace place;
    patch_.evaluate<2>(s, t, place.at);
    place.s_inwards = inwards(s, kSideS0, kSideS1);
    place.t_inwards = inwards(t, kSideT0, kSideT1);
    Values to_foot;
    relative_.evaluate<0>(s, t, to_foot);
    to_foot.value -= away_;
    return isLocalMinimum(place, to_foot.value.head<3>(), best_.tolerance) &&
           facing_->accepts(patch_, s, t, place.at.ds.head<3>(), place.at.dt.head<3>());
  }

  /// The direction in which the sheet goes on from one of the sides at which it ends, 1 or -1; 0
  /// where it goes on both ways.
  double inwards(double parameter, unsigned low_side, unsigned high_side) const {
    return parameter == 0 && (patch_.borders & low_side)    ? 1
           : parameter == 1 && (patch_.borders & high_side) ? -1
                                                            : 0;
  }

  const SearchKernels& kernels_ = SearchKernels::get();
  const BezierPatch& patch_;
  const Facing* facing_;
  ClosestSoFar& best_;
  const BezierPatch::Point away_;
  BezierPatch relative_;  // to the place of the searching point
  double least_;          // a lower bound of the squared distance less the square of the range
  int cells_ = 0;
  std::optional<NormalPolynomial> normals_;
  std::optional<bool> is_line_, is_narrow_;
};

}  // namespace

void closestOnPatch(const BezierPatch& patch, const FootBound& bound, const Facing* facing,
                    ClosestSoFar& best) {
  PatchSearch(patch, facing, best).run(bound);
}

}  // namespace limitsurf
