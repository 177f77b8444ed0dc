// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_inverse.h"

#include <algorithm>

#include "limitsurf/uv/uv_cell_nearest.h"

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

/// A strip along the longer diagonal of a cell's image that contains the image, grown by the
/// tolerance. An axis-aligned box around a slanted, thin image would contain many points that the
/// image does not.
class Strip {
 public:
  Strip(const UvCell& cell, const Point2& tolerance) : origin_(cell.points[0]) {
    const Point2 *p = cell.points, one = p[15] - p[0], other = p[12] - p[3];
    along_ = (one * one).sum() > (other * other).sum() ? one : other;
    for (int i = 0; i < 16; ++i) {
      const double across = acrossOf(p[i]);
      low_ = std::min(low_, across);
      high_ = std::max(high_, across);
    }
    const double grown = (along_.abs() * tolerance.reverse()).sum();
    low_ -= grown;
    high_ += grown;
  }

  bool contains(const Point2& point) const {
    const double across = acrossOf(point);
    return across >= low_ && across <= high_;
  }

  /// Whether all points lie beside the strip. Of many points only the corners are looked at.
  bool isBeside(const Lattice& points) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int y : {points.y0, points.y1}) {
      for (const int x : {points.x0, points.x1}) {
        const double across = acrossOf(Point2(x, y));
        low = std::min(low, across);
        high = std::max(high, across);
      }
    }
    const bool are_corners_all = points.x1 - points.x0 < 2 && points.y1 - points.y0 < 2;
    return low > high_ || high < low_ || (are_corners_all && containsNone(points));
  }

 private:
  double acrossOf(const Point2& point) const { return cross(along_, point - origin_); }

  bool containsNone(const Lattice& points) const {
    return !contains(Point2(points.x0, points.y0)) && !contains(Point2(points.x1, points.y0)) &&
           !contains(Point2(points.x0, points.y1)) && !contains(Point2(points.x1, points.y1));
  }

  Point2 origin_, along_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// By how much the derivatives along s and t change on a cell when s changes, and when t does,
/// relative to their sizes.
Point2 changesOfDerivatives(const UvCell& cell) {
  const Point2* p = cell.points;
  Point2 size = Point2::Zero();        // of the derivatives along s and t
  double same[2] = {}, other[2] = {};  // their changes along themselves and along each other
  const auto sizeOf = [](const Point2& a) { return a.abs().maxCoeff(); };
  for (int direction = 0; direction < 2; ++direction) {
    const int along = direction == 0 ? 1 : 4, across = 5 - along;
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        const Point2* at = p + j * across + i * along;
        const Point2 derivative = at[along] - at[0];
        size[direction] = std::max(size[direction], sizeOf(derivative));
        if (i > 0) {
          same[direction] = std::max(same[direction], sizeOf(derivative - (at[0] - at[-along])));
        }
        if (j > 0) {
          other[direction] =
              std::max(other[direction], sizeOf(derivative - (at[along - across] - at[-across])));
        }
      }
    }
  }
  const auto larger = [&](int one) {
    return std::max(2 * same[one] / size[one], 3 * other[1 - one] / size[1 - one]);
  };
  return {larger(0), larger(1)};
}

/// Divides a cell that cannot be inverted, and returns the number of parts.
///
/// It is halved along one parameter if the derivatives change mostly with that one, else quartered.
/// So the cells beside an edge that is mapped to a point, or beside a fold, become thin at once: a
/// row of squares along the edge would have as many cells as the edge is longer than they are.
int divide(const UvCell& cell, UvCell parts[4]) {
  constexpr double kMostly = 4;
  const Point2 changes = changesOfDerivatives(cell);
  for (int direction = 0; direction < 2; ++direction) {
    if (changes[direction] > kMostly * changes[1 - direction]) {
      cell.halve(direction, parts);
      return 2;
    }
  }
  cell.quarter(parts);
  return 4;
}

/// Whether a cell that cannot be inverted is mirrored at a place with this Jacobian determinant. On
/// an edge that is mapped to a point it is 0, up to rounding: then the rest of the cell decides.
bool isFlipped(const UvCell& cell, double determinant) {
  constexpr double kUnclear = 1e-3;
  const JacobianBounds around(cell);
  const double largest = std::max(std::abs(around.least), std::abs(around.largest));
  return std::abs(determinant) > kUnclear * largest ? determinant < 0
                                                    : around.least + around.largest < 0;
}

}  // namespace

bool LatticeInverse::isFlat(const UvCell& patch) const {
  const Box2 box = patch.box();
  const JacobianBounds jacobian(patch);
  const double area = std::max(std::abs(jacobian.least), std::abs(jacobian.largest));
  return !(area > tolerance_.maxCoeff() * (box.high - box.low).maxCoeff());
}

void LatticeInverse::begin(const Lattice& inside) {
  const std::int64_t points = static_cast<std::int64_t>(inside.x1 - inside.x0 + 1) *
                              static_cast<std::int64_t>(inside.y1 - inside.y0 + 1);
  limit_.divided = work_.divided + kMostCells + points;
  limit_.searches = work_.searches + kMostSearches + 2 * points;
  limit_.trials = work_.trials + kMostTrials + 64 * points;
  deep_cells_ = 0;
}

void LatticeInverse::add(const UvCell& patch) {
  const Lattice inside = within(patch.box());
  if (!inside.empty() && !isFlat(patch)) {
    begin(inside);
    addCell(patch);
  }
}

void LatticeInverse::addPart(const UvCell& part) {
  const Lattice inside = within(part.box());
  if (inside.empty()) {
    return;
  }
  begin(inside);
  if (isFlat(part)) {
    addNearest(part, inside);
  } else {
    addCell(part);
  }
}

bool LatticeInverse::isLast(const UvCell& cell, const Box2& box) {
  if (((box.high - box.low) <= kTiny * tolerance_).all() || work_.divided == limit_.divided ||
      (cell.size <= kLeastSide).any()) {
    return true;
  }
  return cell.size.prod() <= kFreeArea && deep_cells_++ > kMostDeepCells;
}

void LatticeInverse::addCell(const UvCell& cell) {
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
  if (Strip(cell, tolerance_).isBeside(inside)) {
    return;
  }
  if (isLast(cell, box)) {
    addNearest(cell, inside);
    return;
  }
  ++work_.divided;
  UvCell parts[4];
  const int count = divide(cell, parts);
  for (int i = 0; i < count; ++i) {
    addCell(parts[i]);
  }
}

void LatticeInverse::addRows(const UvCell& cell, const CellInverse& inverse,
                             const Lattice& inside) {
  const RowRange ranges(cell, tolerance_);
  for (int first = inside.y0; first <= inside.y1; first += InverseRows::kCount) {
    InverseRows rows;
    int x0[InverseRows::kCount], longest = 0;
    rows.count = std::min(inside.y1 - first + 1, InverseRows::kCount);
    for (int i = 0; i < rows.count; ++i) {
      const int y = first + i;
      const Lattice row = Lattice{inside.x0, y, inside.x1, y}.within(
          ranges.at(y).grown({tolerance_[0], tolerance_[1]}));
      const int length = row.empty() ? 0 : row.x1 - row.x0 + 1;
      x0[i] = row.x0;
      rows.x0[i] = row.x0;
      rows.y[i] = y;
      rows.length[i] = length;
      longest = std::max(longest, length);
    }
    for (int begin = 0; begin < longest; begin += InverseRows::kBlock) {
      const int end = std::min(begin + InverseRows::kBlock, longest);
      kernel_.find(inverse.numbers(), rows, begin, end);
      for (int i = 0; i < rows.count; ++i) {
        const int last = std::min(end, static_cast<int>(rows.length[i]));
        for (int point = begin; point < last; ++point) {
          const int place = point - begin;
          const Point2 at(rows.s[place][i], rows.t[place][i]);
          if (rows.found[place][i] == 1) {
            addPlace(cell, inverse, at, rows.determinant[place][i], x0[i] + point, first + i);
          } else if (rows.found[place][i] > 0) {
            addDoubtful(cell, inverse, at, x0[i] + point, first + i);
          }
        }
      }
    }
  }
}

void LatticeInverse::addPlace(const UvCell& cell, const CellInverse& inverse, const Point2& place,
                              double determinant, int x, int y) {
  Find find;
  find.x = x;
  find.y = y;
  find.s = cell.low[0] + cell.size[0] * (place[0] + 0.5);
  find.t = cell.low[1] + cell.size[1] * (place[1] + 0.5);
  find.flipped = determinant < 0;
  const Point2 from_sides = 0.5 - place.abs();
  if (from_sides.minCoeff() <= inverse.borderWidth()) {
    // The wedge lies between the directions along the sides, counter-clockwise in s and t.
    const bool at_s = from_sides[0] <= inverse.borderWidth();
    const bool at_t = from_sides[1] <= inverse.borderWidth();
    const bool s_low = place[0] < 0, t_low = place[1] < 0;
    Point2 ds, dt;
    inverse.derivatives(place, ds, dt);
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

void LatticeInverse::addDoubtful(const UvCell& cell, const CellInverse& inverse,
                                 const Point2& start, int x, int y) {
  const bool has_wedges = inverse.borderWidth() <= kWidestBorder;
  if (work_.searches == limit_.searches || !(has_wedges || sink_.wants(x, y, cell))) {
    return;
  }
  ++work_.searches;
  const CellNearest nearest(cell, Point2(x, y), tolerance_, start + 0.5);
  if (nearest.isReached()) {
    addPlace(cell, inverse, nearest.at() - 0.5, nearest.determinant(), x, y);
  }
}

void LatticeInverse::addNearest(const UvCell& cell, const Lattice& inside) {
  const Strip strip(cell, tolerance_);
  for (int y = inside.y0; y <= inside.y1; ++y) {
    for (int x = inside.x0; x <= inside.x1; ++x) {
      if (work_.searches == limit_.searches || work_.trials == limit_.trials) {
        return;
      }
      ++work_.trials;
      if (!strip.contains(Point2(x, y)) || !sink_.wants(x, y, cell)) {
        continue;
      }
      ++work_.searches;
      const CellNearest nearest(cell, Point2(x, y), tolerance_, Point2::Constant(0.5));
      if (nearest.isReached()) {
        Find find;
        find.x = x;
        find.y = y;
        find.s = cell.low[0] + cell.size[0] * nearest.at()[0];
        find.t = cell.low[1] + cell.size[1] * nearest.at()[1];
        find.flipped = isFlipped(cell, nearest.determinant());
        find.on_border = true;
        sink_.add(find);
      }
    }
  }
}

}  // namespace limitsurf
