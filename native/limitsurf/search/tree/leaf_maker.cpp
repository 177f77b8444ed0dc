// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/leaf_maker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "limitsurf/parallel.h"
#include "limitsurf/search/patch_sides.h"
#include "limitsurf/search/tree/box_points.h"

namespace limitsurf {
namespace {

Vector3 sideS(const BezierPatch& patch) { return sidesAlongS(patch.points).head<3>(); }
Vector3 sideT(const BezierPatch& patch) { return sidesAlongT(patch.points).head<3>(); }

/// The area of the quadrilateral between the corners, if it is flat.
double cornerArea(const BezierPatch& patch) {
  const BezierPatch::Point* p = patch.points;
  const Vector3 one = (p[15] - p[0]).head<3>(), other = (p[12] - p[3]).head<3>();
  return 0.5 * one.cross(other).norm();
}

}  // namespace

LeafMaker::Leaf LeafMaker::ofPatch(const SurfacePiece& piece, const BezierPatch& patch) const {
  BoxPoints points(middle_);
  points.reserve(16);
  points.add(patch);
  return {{points.oriented<float>(sideS(patch), sideT(patch)), piece, FootBound(patch)},
          points.axisAligned()};
}

LeafMaker::Leaf LeafMaker::ofCore(const SurfacePiece& core,
                                  SurfacePatches::SplitCore& split) const {
  // The box is found from the patches of one more step and the hull of the rest.
  patches_.splitPatches(core, split);
  BoxPoints points(middle_);
  points.reserve(3 * 16 + 8);
  for (const BezierPatch& patch : split.patches) {
    points.add(patch);
  }
  const CoreHull rest = patches_.restHull(split);
  points.add(rest);
  // The core's opposite corner, the last point of the second patch, gives the first axis.
  const Vector3 normal = rest.axes.row(2);
  const Vector3 along = points.point(2 * 16 - 1) - (rest.vertex - middle_);
  const Vector3 tangent = along - along.dot(normal) * normal;
  return {{points.oriented<float>(tangent, normal.cross(tangent)), core, {}}, points.axisAligned()};
}

LeafMaker::Leaf LeafMaker::ofRing(int ring) const {
  const int first = rings_.firstLevel(ring);
  BoxPoints points(middle_);
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  for (int place = 0; place < rings_.coreCount(ring); ++place) {
    stride.step();
    patches_.splitPatches(rings_.core(ring, place, first), split);
    for (const BezierPatch& patch : split.patches) {
      points.add(patch);
    }
    points.add(patches_.restHull(split));
  }
  const Eigen::Matrix3d frame = patches_.ringFrame(ring);
  return {{points.oriented<float>(frame.row(0), frame.row(1)), rings_.core(ring, 0, first), {}},
          points.axisAligned()};
}

int LeafMaker::stepsBefore(const SurfacePiece& core) const {
  const int ring = patches_.ringOf(core);
  if (rings_.isLarge(ring)) {
    return rings_.firstLevel(ring) - patches_.ringLevel(core);
  }
  // The cores of small tiles are split once, those of whole faces twice.
  const FaceRectangle on = patches_.rectangle(core);
  return std::abs(on.us + on.ut) == 1 ? 2 : 1;
}

template <typename OnPatch, typename OnRest>
void LeafMaker::visit(const std::vector<SurfacePiece>& pieces, const OnPatch& onPatch,
                      const OnRest& onRest) const {
  SurfacePatches::SplitCore split;
  std::vector<Padded> rest_points;
  for (const SurfacePiece& piece : pieces) {
    if (!piece.isCore()) {
      onPatch(patches_.patch(piece));
      continue;
    }
    const bool is_of_ring = isOfRing(piece);
    SurfacePiece rest = piece;
    for (int step = is_of_ring ? stepsBefore(piece) : 1; step > 0; --step) {
      patches_.splitPatches(rest, split);
      rest = split.core;
      for (const BezierPatch& patch : split.patches) {
        onPatch(patch);
      }
    }
    if (!is_of_ring) {
      rest_points.clear();
      patches_.appendRestPoints(split, rest_points);
      onRest(rest_points);
    }
  }
}

LeafMaker::BoxedArea LeafMaker::boxAround(const std::vector<SurfacePiece>& pieces) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Padded low = Padded::Constant(kInfinity), high = -low;
  double area = 0;
  const auto include = [&](const Padded& point) {
    low = low.min(point);
    high = high.max(point);
  };
  visit(
      pieces,
      [&](const BezierPatch& patch) {
        for (const Padded& point : patch.points) {
          include(patch.anchor + point);
        }
        area += cornerArea(patch);
      },
      [&](const std::vector<Padded>& points) {
        std::for_each(points.begin(), points.end(), include);
      });
  return {{low.head<3>().matrix() - middle_, high.head<3>().matrix() - middle_}, area};
}

LeafBox LeafMaker::orientedBoxAround(const std::vector<SurfacePiece>& pieces) const {
  BoxPoints points(middle_);
  visit(
      pieces, [&](const BezierPatch& patch) { points.add(patch); },
      [&](const std::vector<Padded>& rest) { points.add(rest); });
  return points.alongPrincipalAxes();
}

}  // namespace limitsurf
