// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_search.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/number_text.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/parallel.h"
#include "limitsurf/uv/uv_raster.h"

namespace limitsurf {
namespace {

/// The number of points in a task. It is small because a point takes a millisecond where thousands
/// of faces lie on each other, and Ctrl-C takes effect only between tasks.
constexpr std::size_t kPointsPerTask = 64;

/// The squares of distances between larger coordinates would overflow.
constexpr double kFarthest = 1e150;

bool contains(const BoxF& box, const Point2& point) {
  return point[0] >= box.low[0] && point[0] <= box.high[0] && point[1] >= box.low[1] &&
         point[1] <= box.high[1];
}

}  // namespace

void checkPoints(const PlanePoints& points) {
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    if (!(points.row(row).cwiseAbs().maxCoeff() <= kFarthest) || !points.row(row).allFinite()) {
      std::ostringstream message;
      message << "row " << row << ": points is (" << numberText(points(row, 0)) << ", "
              << numberText(points(row, 1)) << "), which "
              << (points.row(row).allFinite()
                      ? "is too far away; coordinates must be at most " + numberText(kFarthest)
                      : "is not finite");
      throw std::invalid_argument(message.str());
    }
  }
}

UvSearch::UvSearch(const UvPatches& map, int threads)
    : map_(map),
      middle_(map.patches().middle().head<2>().array()),
      scale_(scaleToOwnUnit(map.patches().diagonal())) {
  std::vector<BoxF> boxes;
  boxes.reserve(map.pieces().size());
  for (const UvPiece& piece : map.pieces()) {
    const Box2 in_map = piece.box.grown(Point2::Constant(map.tolerance()));
    const Point2 low = (in_map.low - middle_) * scale_, high = (in_map.high - middle_) * scale_;
    boxes.emplace_back(Box{{low[0], low[1], 0}, {high[0], high[1], 0}});
  }
  tree_ = std::make_unique<BoxTree>(boxes, order_, threads);
}

MapLocations UvSearch::locate(const PlanePoints& points, int threads) const {
  const auto rows = static_cast<std::size_t>(points.rows());
  MapLocations out;
  resizeInParts(out.at, rows);
  out.overlap.resize(rows);
  out.flipped.resize(rows);
  parallelFor(rows, kPointsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    constexpr Lattice kOnePoint{0, 0, 0, 0};
    std::vector<LatticeFinds::Slot> slots;
    for (std::size_t row = begin; row < end; ++row) {
      LatticeFinds finds(kOnePoint, slots);
      LatticeInverse inverse(kOnePoint, Point2::Constant(map_.tolerance() * scale_), finds);
      find(points.row(static_cast<Eigen::Index>(row)).transpose().array(), inverse, finds);
      finds.finish();
      const LatticeFinds::Slot& slot = finds.at(0, 0);
      if (slot.face >= 0) {
        out.at[row] = {slot.face, slot.u, slot.v};
        out.overlap[row] = slot.overlap;
        out.flipped[row] = slot.flipped;
      }
    }
  });
  return out;
}

void UvSearch::find(const Point2& point, LatticeInverse& inverse, UvPatches::Sink& finds) const {
  if (tree_->empty()) {
    return;
  }
  const PlaneFrame frame{point, Point2::Constant(scale_), 0};  // small areas would vanish
  const Point2 in_boxes = (point - middle_) * scale_;
  std::int32_t stack[BoxTree::kMostDepth + 1] = {0};
  int depth = 1;
  while (depth > 0) {
    const BoxTree::Node& node = tree_->node(stack[--depth]);
    for (int side = 0; side < 2; ++side) {
      const std::int32_t child = node.children[side];
      if (!contains(node.boxes[side], in_boxes)) {
        continue;
      }
      if (BoxTree::isLeaf(child)) {
        const auto piece = static_cast<std::size_t>(order_[BoxTree::leaf(child)]);
        map_.invert(map_.pieces()[piece], frame, inverse, finds);
      } else {
        stack[depth++] = child;
      }
    }
  }
}

}  // namespace limitsurf
