// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_borders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Two sides are the same if their ends and middles are no farther apart than this many tolerances:
/// many times the error of an evaluation, and far less than the length of a side.
constexpr double kSame = 100;

/// A cell in which a map folds back becomes a point when it is at most this many texels large.
constexpr double kFoldDetail = 0.25;

constexpr std::size_t kPiecesPerTask = 1024;

/// The bits of all four sides, and of the two sides of a core that meet at its vertex.
constexpr unsigned kAllSides = 15u, kVertexSides = 9u;

/// The control points of side i of a patch, which leads from corner i to the next.
constexpr int kSidePoints[4][4] = {{0, 1, 2, 3}, {3, 7, 11, 15}, {15, 14, 13, 12}, {12, 8, 4, 0}};
constexpr double kCorners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};

const PlaneFrame kMapFrame{Point2::Zero(), Point2::Ones(), 0};

/// A side of a piece, directed so that the piece lies to its left.
struct DirectedSide {
  std::int64_t x, y;  // the middle, rounded
  Point2 begin, end;
  std::uint32_t piece;
  std::uint32_t side;
};

Point2 middle(const Point2 curve[4]) {
  return 0.125 * ((curve[0] + curve[3]) + 3 * (curve[1] + curve[2]));
}

/// The signs that the Jacobian determinant takes on a piece, up to the tolerance.
struct Orientation {
  void include(const UvCell& cell, double tolerance) {
    const JacobianBounds jacobian(cell);
    const Box2 box = cell.box();
    const double length = (box.high - box.low).maxCoeff();
    const double flat = tolerance * length;
    positive |= jacobian.largest > flat;
    negative |= jacobian.least < -flat;
  }
  bool isFlipped() const { return negative && !positive; }
  bool folds() const { return negative && positive; }
  bool isFlat() const { return !negative && !positive; }

  bool positive = false, negative = false;
};

/// The ends and the middle of a side.
struct SidePoints {
  Point2 begin, middle, end;
};

/// The four sides of a piece, in the order of its corners, and its orientation.
struct PieceOutline {
  SidePoints sides[4];
  Orientation orientation;
};

PieceOutline outlineOfPatch(const UvPatches& map, const BezierPatch& patch) {
  const UvCell cell = cellOf(patch, kMapFrame);
  PieceOutline outline;
  outline.orientation.include(cell, map.tolerance());
  for (int side = 0; side < 4; ++side) {
    Point2 curve[4];
    for (int k = 0; k < 4; ++k) {
      curve[k] = cell.points[kSidePoints[side][k]];
    }
    outline.sides[side] = {curve[0], middle(curve), curve[3]};
  }
  return outline;
}

/// The outline of a core, from the three patches of its first split: each side has its middle where
/// two of them meet.
PieceOutline outlineOfCore(const UvPatches& map, const SurfacePiece& core) {
  SurfacePatches::SplitCore split;
  map.patches().split(core, split);
  PieceOutline outline;
  UvCell cells[3];
  for (int quarter = 0; quarter < 3; ++quarter) {
    cells[quarter] = cellOf(split.patches[quarter], kMapFrame);
    outline.orientation.include(cells[quarter], map.tolerance());
  }
  const Point2 vertex = map.patches().coreVertex(core).head<2>().array();
  const auto corner = [&](int quarter, int point) { return cells[quarter].points[point]; };
  outline.sides[0] = {vertex, corner(0, 0), corner(0, 3)};
  outline.sides[1] = {corner(0, 3), corner(0, 15), corner(1, 15)};
  outline.sides[2] = {corner(1, 15), corner(1, 12), corner(2, 12)};
  outline.sides[3] = {corner(2, 12), corner(2, 0), vertex};
  return outline;
}

PieceOutline outlineOf(const UvPatches& map, const SurfacePiece& piece) {
  return piece.isCore() ? outlineOfCore(map, piece)
                        : outlineOfPatch(map, map.patches().patch(piece));
}

DirectedSide directedSide(const SidePoints& points, bool flipped, std::uint32_t piece,
                          std::uint32_t side, double same) {
  DirectedSide out;
  out.x = std::llround(points.middle[0] / same);
  out.y = std::llround(points.middle[1] / same);
  out.begin = flipped ? points.end : points.begin;
  out.end = flipped ? points.begin : points.end;
  out.piece = piece;
  out.side = side;
  return out;
}

/// Calls visit(side) for each side along which another piece runs in the opposite direction. Sorts
/// the sides.
template <typename Visit>
void forEachSharedSide(std::vector<DirectedSide>& sides, double same, const Visit& visit) {
  std::sort(sides.begin(), sides.end(), [](const DirectedSide& a, const DirectedSide& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first + 1;
    while (last < sides.size() && sides[last].x == sides[first].x &&
           sides[last].y == sides[first].y) {
      ++last;
    }
    for (std::size_t a = first; a < last; ++a) {
      for (std::size_t b = first; b < last; ++b) {
        const DirectedSide &one = sides[a], &other = sides[b];
        if (((one.begin - other.end).abs() <= same).all() &&
            ((one.end - other.begin).abs() <= same).all() && a != b) {
          visit(one);
          break;
        }
      }
    }
    first = last;
  }
}

/// Appends points of the curves along which the map folds back on a cell.
void appendFolds(const UvCell& cell, const FaceRectangle& on, const Box2& around,
                 InterruptionStride& stride, std::vector<BorderCurve>& out) {
  stride.step();
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
    curve.begin = curve.end = cell.low + 0.5 * cell.size;
    curve.flipped = cross(ds, dt) < 0;
    out.push_back(curve);
    return;
  }
  UvCell quarters[4];
  cell.quarter(quarters);
  for (const UvCell& quarter : quarters) {
    appendFolds(quarter, on, around, stride, out);
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
      const PieceOutline outline = outlineOf(map, map.pieces()[i].piece);
      const Orientation& o = outline.orientation;
      all[i] = {static_cast<int>(i), o.isFlat() ? 0u : kAllSides, o.isFlipped(), o.folds()};
      for (std::uint32_t side = 0; side < 4; ++side) {
        directed[4 * i + side] = directedSide(outline.sides[side], o.isFlipped(),
                                              static_cast<std::uint32_t>(i), side, same);
      }
    }
  });
  directed.erase(std::remove_if(directed.begin(), directed.end(),
                                [&](const DirectedSide& side) {
                                  return all[side.piece].folds || all[side.piece].sides == 0;
                                }),
                 directed.end());
  forEachSharedSide(directed, same,
                    [&](const DirectedSide& side) { all[side.piece].sides &= ~(1u << side.side); });
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

void UvBorders::appendLastSides(const Sides& of, const PlaneFrame& frame, const SurfacePiece& core,
                                const SurfacePatches::SplitCore& split,
                                std::vector<BorderCurve>& out) const {
  const Point2 vertex = frame.at(map_.patches().coreVertex(core).head<2>().array());
  for (const int side : {0, 3}) {
    if (of.sides & (1u << side)) {
      const BezierPatch& beside = split.patches[side == 0 ? 0 : 2];
      const Point2 corner = frame.at(Point2((beside.anchor + beside.points[0]).head<2>()));
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
}

void UvBorders::appendCoreSides(const Sides& of, const PlaneFrame& frame, const Box2& around,
                                double detail, InterruptionStride& stride,
                                std::vector<BorderCurve>& out) const {
  SurfacePatches::SplitCore split;
  SurfacePiece core = map_.pieces()[static_cast<std::size_t>(of.piece)].piece;
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
        appendFolds(cellOf(patch, frame), patch.on, around, stride, out);
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
    if ((of.sides & kVertexSides) == 0 && !of.folds) {
      return;
    }
    if (size.maxCoeff() > detail && core.steps < SurfacePatches::kMostSteps) {
      continue;
    }
    appendLastSides(of, frame, core, split, out);
    return;
  }
}

void UvBorders::appendCurves(const PlaneFrame& frame, const Box2& box, double reach, double detail,
                             std::vector<BorderCurve>& out) const {
  const Box2 around = box.grown(Point2::Constant(reach));
  InterruptionStride stride;
  for (const Sides& of : sides_) {
    stride.step();
    const UvPiece& piece = map_.pieces()[static_cast<std::size_t>(of.piece)];
    const Box2 image = frame.at(piece.box);
    if ((image.high < around.low).any() || (image.low > around.high).any()) {
      continue;
    }
    if (piece.piece.isCore()) {
      appendCoreSides(of, frame, around, detail, stride, out);
      continue;
    }
    const BezierPatch patch = map_.patches().patch(piece.piece);
    for (int side = 0; side < 4; ++side) {
      if (of.sides & (1u << side)) {
        appendSide(patch, side, of.flipped, frame, out);
      }
    }
    if (of.folds) {
      appendFolds(cellOf(patch, frame), patch.on, around, stride, out);
    }
  }
}

}  // namespace limitsurf
