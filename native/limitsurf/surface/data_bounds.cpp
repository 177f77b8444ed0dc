// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/patches/face_squares.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {
namespace {

/// More boxes than this fit into no machine's memory.
constexpr std::size_t kMostBoxes = std::size_t{1} << 36;
constexpr std::size_t kFacesPerTask = 64;

/// Cores of smaller values are not split, because squares of lengths around their vertices would
/// underflow: their boxes are then those of the whole face's control points.
constexpr double kSmallest = 1e-140;

/// The part of one side of a square that a piece of the surface covers, in the piece's parameter.
struct Part {
  double begin, end;
};

/// The boxes of the squares of one face, in three columns.
class FaceBoxes {
 public:
  FaceBoxes(const SurfacePatches& patches, int side)
      : patches_(patches),
        side_(side),
        splits_(patches.diagonal() / patches.scale() > kSmallest),
        boxes_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  const std::vector<Box>& boxes() const { return boxes_; }
  void clear() { std::fill(boxes_.begin(), boxes_.end(), Box()); }

  void include(const SurfacePiece& piece) {
    if (piece.isCore()) {
      includeCore(piece);
    } else {
      includePatch(patches_.patch(piece));
    }
  }

 private:
  Box& box(int column, int row) {
    return boxes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
                  static_cast<std::size_t>(column)];
  }

  /// Splits a core until the rest is no larger than a square.
  void includeCore(SurfacePiece core) {
    Box whole = patches_.coreBox(core);
    SurfacePatches::SplitCore split;
    double size = sizeOf(patches_.rectangle(core));
    while (splits_ && size * side_ > 1 && core.steps < SurfacePatches::kMostSteps) {
      patches_.split(core, split);
      for (const BezierPatch& patch : split.patches) {
        includePatch(patch);
      }
      core = split.core;
      whole = split.core_box;
      size /= 2;
    }
    const FaceRectangle on = patches_.rectangle(core);
    forSquares(on, [&](int column, int row) { box(column, row).include(whole); });
  }

  static double sizeOf(const FaceRectangle& on) {
    return std::max(std::abs(on.us) + std::abs(on.ut), std::abs(on.vs) + std::abs(on.vt));
  }

  /// Calls each(column, row) for the squares that a rectangle overlaps.
  template <typename Each>
  void forSquares(const FaceRectangle& on, const Each& each) const {
    const auto [u0, u1, v0, v1] = on.extent();
    const FaceSquares columns = squaresBetween(u0, u1, side_), rows = squaresBetween(v0, v1, side_);
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        each(column, row);
      }
    }
  }

  void includePatch(const BezierPatch& patch) {
    const FaceRectangle& on = patch.on;
    const bool turned = on.us == 0;  // u runs along t
    forSquares(on, [&](int column, int row) {
      const Part along_u = partOf(column, on.u0, turned ? on.ut : on.us);
      const Part along_v = partOf(row, on.v0, turned ? on.vs : on.vt);
      const Part s = turned ? along_v : along_u, t = turned ? along_u : along_v;
      BezierPatch::Point points[16];
      std::copy_n(patch.points, 16, points);
      if (s.begin > 0 || s.end < 1) {
        for (int i = 0; i < 4; ++i) {
          bezier::cut(points + 4 * i, 1, s.begin, s.end);
        }
      }
      if (t.begin > 0 || t.end < 1) {
        for (int i = 0; i < 4; ++i) {
          bezier::cut(points + i, 4, t.begin, t.end);
        }
      }
      Box& around = box(column, row);
      for (const BezierPatch::Point& point : points) {
        around.include((patch.anchor + point).head<3>().matrix());
      }
    });
  }

  /// Which part of a patch lies on a square, along one of the patch's parameters: the coordinate of
  /// the face is low + size * parameter.
  Part partOf(int square, double low, double size) const {
    const double a = (static_cast<double>(square) / side_ - low) / size,
                 b = (static_cast<double>(square + 1) / side_ - low) / size;
    return {std::clamp(std::min(a, b), 0., 1.), std::clamp(std::max(a, b), 0., 1.)};
  }

  const SurfacePatches& patches_;
  int side_;
  bool splits_;
  std::vector<Box> boxes_;
};

/// A corner of a box, moved outwards by the padding, whose sign says which corner it is, and by
/// some units of the rounding of values far from 0. Where all control values are 0 so is everything
/// that is evaluated, and the box stays as it is.
Vector3 padded(const Vector3& corner, const Box& box, double padding) {
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  const Vector3 largest = box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs());
  Vector3 result = corner;
  for (int i = 0; i < 3; ++i) {
    if (largest[i] > 0) {
      result[i] += padding + std::copysign(kRounding * largest[i], padding);
    }
  }
  return result;
}

/// For each face the first of its tiles; tiles are in the order of their faces.
std::vector<int> firstTiles(const SurfacePatches& patches, int faces) {
  std::vector<int> first(static_cast<std::size_t>(faces) + 1, 0);
  std::vector<SurfacePiece> pieces;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    ++first[static_cast<std::size_t>(patches.rectangle(pieces.front()).face) + 1];
  }
  for (std::size_t face = 0; face + 1 < first.size(); ++face) {
    first[face + 1] += first[face];
  }
  return first;
}

}  // namespace

DataBounds SurfaceData::bounds(int side, int threads) const {
  checkThreads(threads);
  if (side < 1 || side > kMostBoundsSide) {
    throw std::invalid_argument("side is " + std::to_string(side) + "; it must be 1 to " +
                                std::to_string(kMostBoundsSide));
  }
  const std::size_t squares = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const auto faces = static_cast<std::size_t>(faceCount());
  if (faces > kMostBoxes / squares) {
    throw std::invalid_argument("side is " + std::to_string(side) + " on " + std::to_string(faces) +
                                " faces; the limit is " + std::to_string(kMostBoxes) + " boxes");
  }
  DataBounds result;
  const auto rows = static_cast<Eigen::Index>(faces * squares);
  result.low.resize(rows, columns());
  result.high.resize(rows, columns());
  for (Eigen::Index first = 0; first < columns(); first += 3) {
    const SurfacePatches patches(*this, threads, first, PatchUnit::own);
    const std::vector<int> tiles = firstTiles(patches, faceCount());
    const double padding = kBoundsPadding * patches.diagonal();
    const Eigen::Index count = std::min<Eigen::Index>(3, columns() - first);
    parallelFor(faces, kFacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      FaceBoxes boxes(patches, side);
      std::vector<SurfacePiece> pieces;
      for (std::size_t face = begin; face < end; ++face) {
        pieces.clear();
        for (int tile = tiles[face]; tile < tiles[face + 1]; ++tile) {
          patches.appendPieces(tile, pieces);
        }
        boxes.clear();
        for (const SurfacePiece& piece : pieces) {
          boxes.include(piece);
        }
        auto row = static_cast<Eigen::Index>(face * squares);
        for (const Box& box : boxes.boxes()) {
          const Vector3 nothing = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
          const Vector3 low = pieces.empty() ? nothing : padded(box.low, box, -padding);
          const Vector3 high = pieces.empty() ? nothing : padded(box.high, box, padding);
          result.low.row(row).segment(first, count) = low.head(count).transpose() / patches.scale();
          result.high.row(row).segment(first, count) =
              high.head(count).transpose() / patches.scale();
          ++row;
        }
      }
    });
  }
  return result;
}

}  // namespace limitsurf
