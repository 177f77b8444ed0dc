// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_border.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Sides count as the same if their ends and middles are no farther apart than so many tolerances.
constexpr double kSame = 100;

/// Cells in which a map folds back become points when they are so small.
constexpr double kFoldDetail = 0.25;

constexpr std::size_t kPiecesPerTask = 1024;

/// Side i of a patch, from its corner i to the next: its control points.
constexpr int kSidePoints[4][4] = {{0, 1, 2, 3}, {3, 7, 11, 15}, {15, 14, 13, 12}, {12, 8, 4, 0}};
constexpr double kCorners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};

const PlaneFrame kMapFrame{Point2::Zero(), Point2::Ones(), 0};

/// A side of a piece, so directed that the piece lies to its left.
struct DirectedSide {
  std::int64_t x, y;  // of the middle, rounded
  Point2 begin, end;
  std::uint32_t piece;
  std::uint32_t side;
};

Point2 middle(const Point2 curve[4]) {
  return 0.125 * ((curve[0] + curve[3]) + 3 * (curve[1] + curve[2]));
}

/// What a piece's Jacobian determinant does.
struct Orientation {
  void include(const UvCell& cell, double tolerance) {
    const JacobianBounds jacobian(cell);
    const Box2 box = cell.box();
    const double length = (box.high - box.low).maxCoeff();
    const double flat = tolerance * length;
    positive |= jacobian.largest > flat;
    negative |= jacobian.least < -flat;
  }
  bool positive = false, negative = false;
};

/// Ends and middle of a side.
struct SidePoints {
  Point2 begin, middle, end;
};

/// Appends points along the curves on which a cell folds.
void appendFolds(const UvCell& cell, const FaceRectangle& on, const Box2& around,
                 std::vector<BorderCurve>& out) {
  const Box2 box = cell.box();
  const JacobianBounds jacobian(cell);
  if (!(jacobian.least <= 0 && jacobian.largest >= 0) || (box.high < around.low).any() ||
      (box.low > around.high).any()) {
    return;
  }
  if (((box.high - box.low) <= kFoldDetail).all()) {
    BorderCurve curve;
    Point2 ds, dt;
    cell.evaluate(0.5, 0.5, curve.points[0], ds, dt);
    std::fill_n(curve.points + 1, 3, curve.points[0]);
    curve.on = on;
    curve.begin = curve.end = Point2(cell.s0, cell.t0) + 0.5 * cell.size;
    curve.flipped = cross(ds, dt) < 0;
    out.push_back(curve);
    return;
  }
  UvCell quarters[4];
  cell.quarter(quarters);
  for (const UvCell& quarter : quarters) {
    appendFolds(quarter, on, around, out);
  }
}

}  // namespace

UvBorders::UvBorders(const UvPatches& map, int threads) : map_(map) {
  const std::size_t count = map.pieces().size();
  const double same = kSame * map.tolerance();
  std::vector<Sides> all(count);
  std::vector<DirectedSide> directed(4 * count);
  parallelFor(count, kPiecesPerTask, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const SurfacePiece& piece = map.pieces()[i].piece;
      SidePoints points[4];
      Orientation orientation;
      if (piece.isCore()) {
        SurfacePatches::SplitCore split;
        map.patches().split(piece, split);
        UvCell cells[3];
        for (int quarter = 0; quarter < 3; ++quarter) {
          cells[quarter] = cellOf(split.patches[quarter], kMapFrame);
          orientation.include(cells[quarter], map.tolerance());
        }
        const Point2 vertex = map.patches().coreVertex(piece).head<2>().array();
        const auto corner = [&](int quarter, int point) { return cells[quarter].points[point]; };
        points[0] = {vertex, corner(0, 0), corner(0, 3)};
        points[1] = {corner(0, 3), corner(0, 15), corner(1, 15)};
        points[2] = {corner(1, 15), corner(1, 12), corner(2, 12)};
        points[3] = {corner(2, 12), corner(2, 0), vertex};
      } else {
        const UvCell cell = cellOf(map.patches().patch(piece), kMapFrame);
        orientation.include(cell, map.tolerance());
        for (int side = 0; side < 4; ++side) {
          Point2 curve[4];
          for (int k = 0; k < 4; ++k) {
            curve[k] = cell.points[kSidePoints[side][k]];
          }
          points[side] = {curve[0], middle(curve), curve[3]};
        }
      }
      const bool flipped = orientation.negative && !orientation.positive;
      const bool folds = orientation.negative && orientation.positive;
      const bool flat = !orientation.negative && !orientation.positive;
      all[i] = {static_cast<int>(i), flat ? 0u : 15u, flipped, folds};
      for (std::uint32_t side = 0; side < 4; ++side) {
        const SidePoints& p = points[side];
        DirectedSide& out = directed[4 * i + side];
        out.x = std::llround(p.middle[0] / same);
        out.y = std::llround(p.middle[1] / same);
        out.begin = flipped ? p.end : p.begin;
        out.end = flipped ? p.begin : p.end;
        out.piece = static_cast<std::uint32_t>(i);
        out.side = side;
      }
    }
  });
  directed.erase(std::remove_if(directed.begin(), directed.end(),
                                [&](const DirectedSide& side) {
                                  return all[side.piece].folds || all[side.piece].sides == 0;
                                }),
                 directed.end());
  std::sort(directed.begin(), directed.end(), [](const DirectedSide& a, const DirectedSide& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  for (std::size_t first = 0; first < directed.size();) {
    std::size_t last = first + 1;
    while (last < directed.size() && directed[last].x == directed[first].x &&
           directed[last].y == directed[first].y) {
      ++last;
    }
    for (std::size_t a = first; a < last; ++a) {
      for (std::size_t b = first; b < last; ++b) {
        const DirectedSide &one = directed[a], &other = directed[b];
        if (((one.begin - other.end).abs() <= same).all() &&
            ((one.end - other.begin).abs() <= same).all() && a != b) {
          all[one.piece].sides &= ~(1u << one.side);
          break;
        }
      }
    }
    first = last;
  }
  for (const Sides& sides : all) {
    if (sides.sides != 0) {
      sides_.push_back(sides);
    }
  }
}

void UvBorders::appendSide(const BezierPatch& patch, int side, bool flipped,
                           const PlaneFrame& frame, std::vector<BorderCurve>& out) const {
  const UvCell cell = cellOf(patch, frame);
  BorderCurve curve;
  for (int k = 0; k < 4; ++k) {
    curve.points[k] = cell.points[kSidePoints[side][k]];
  }
  curve.on = patch.on;
  curve.begin = {kCorners[side][0], kCorners[side][1]};
  curve.end = {kCorners[side + 1][0], kCorners[side + 1][1]};
  curve.flipped = flipped;
  out.push_back(curve);
}

void UvBorders::appendCoreSides(const Sides& of, const PlaneFrame& frame, const Box2& around,
                                double detail, std::vector<BorderCurve>& out) const {
  SurfacePatches::SplitCore split;
  SurfacePiece core = map_.pieces()[static_cast<std::size_t>(of.piece)].piece;
  const Point2 vertex = frame.at(map_.patches().coreVertex(core).head<2>().array());
  const auto append = [&](int quarter, int side) {
    if (of.sides & (1u << side)) {
      appendSide(split.patches[quarter], side, of.flipped, frame, out);
    }
  };
  for (bool first = true;; first = false) {
    map_.patches().split(core, split);
    core = split.core;
    append(0, 0);
    append(2, 3);
    if (of.folds) {
      for (const BezierPatch& patch : split.patches) {
        appendFolds(cellOf(patch, frame), patch.on, around, out);
      }
    }
    if (first) {
      append(0, 1);
      append(1, 1);
      append(1, 2);
      append(2, 2);
    }
    const Point2 size =
        (split.core_box.high - split.core_box.low).head<2>().array().abs() * frame.scale;
    if ((of.sides & 9u) == 0 && !of.folds) {
      return;
    }
    if (size.maxCoeff() > detail && core.steps < SurfacePatches::kMostSteps) {
      continue;
    }
    // The rest, so short that it may be straight.
    for (const int side : {0, 3}) {
      if (of.sides & (1u << side)) {
        const Point2 corner = frame.at(Point2(
            (split.patches[side == 0 ? 0 : 2].anchor + split.patches[side == 0 ? 0 : 2].points[0])
                .head<2>()));
        BorderCurve curve;
        for (int k = 0; k < 4; ++k) {
          curve.points[k] = vertex + k / 3. * (corner - vertex);
        }
        curve.on = map_.patches().rectangle(core);
        curve.begin = {0, 0};
        curve.end = side == 0 ? Point2(1, 0) : Point2(0, 1);
        curve.flipped = of.flipped;
        out.push_back(curve);
      }
    }
    return;
  }
}

void UvBorders::appendCurves(const PlaneFrame& frame, const Box2& box, double reach, double detail,
                             std::vector<BorderCurve>& out) const {
  const Box2 around = box.grown(Point2::Constant(reach));
  for (const Sides& of : sides_) {
    const UvPiece& piece = map_.pieces()[static_cast<std::size_t>(of.piece)];
    const Box2 image = frame.at(piece.box);
    if ((image.high < around.low).any() || (image.low > around.high).any()) {
      continue;
    }
    if (piece.piece.isCore()) {
      appendCoreSides(of, frame, around, detail, out);
      continue;
    }
    const BezierPatch patch = map_.patches().patch(piece.piece);
    for (int side = 0; side < 4; ++side) {
      if (of.sides & (1u << side)) {
        appendSide(patch, side, of.flipped, frame, out);
      }
    }
    if (of.folds) {
      appendFolds(cellOf(patch, frame), patch.on, around, out);
    }
  }
}

}  // namespace limitsurf
