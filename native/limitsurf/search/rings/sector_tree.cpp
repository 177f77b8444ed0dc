// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rings/sector_tree.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/interruption_point.h"
#include "limitsurf/search/tree/box_points.h"

namespace limitsurf {
namespace {

/// Directions of some faces: sums of unit vectors away from the vertex, and of normals.
struct Directions {
  Vector3 along = Vector3::Zero(), normal = Vector3::Zero();
  int faces = 0;
};

/// Faces that go around the vertex more than about this far have no common direction.
constexpr double kLeastLength = 0.5;

}  // namespace

SectorTree::SectorTree(const SurfacePatches& patches, const std::vector<SurfacePiece>& cores)
    : count_(static_cast<int>(cores.size())), boxes_(2 * cores.size()) {
  const Eigen::Matrix3d frame = patches.ringFrame(patches.ringOf(cores[0]));
  const Vector3 vertex = patches.coreVertex(cores[0]);
  std::vector<Directions> directions(boxes_.size());
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  for (int i = 0; i < count_; ++i) {
    stride.step();
    patches.split(cores[static_cast<std::size_t>(i)], split);
    BoxPoints points(vertex);
    points.reserve(3 * 16);
    for (const BezierPatch& patch : split.patches) {
      points.add(patch);
    }
    // The core's opposite corner is the last point of the second patch; its next corners are the
    // last of the first patch's first row and the first of the third patch's last row.
    const Vector3 along = points.point(31), s = points.point(3), t = points.point(32 + 12);
    const Vector3 across = t - s, normal = along.cross(across);
    const std::size_t leaf = static_cast<std::size_t>(count_ + i);
    boxes_[leaf] = points.oriented<double>(along, across);
    directions[leaf] = {along.normalized(), normal.normalized(), 1};
  }
  for (std::size_t node = static_cast<std::size_t>(count_) - 1; node >= kRoot; --node) {
    stride.step();
    const Directions &a = directions[2 * node], &b = directions[2 * node + 1];
    Directions& both = directions[node];
    both = {a.along + b.along, a.normal + b.normal, a.faces + b.faces};
    BoxPoints corners(Vector3::Zero());
    corners.add(boxes_[2 * node]);
    corners.add(boxes_[2 * node + 1]);
    const bool is_sector = both.along.norm() > kLeastLength * both.faces;
    const Vector3 along = is_sector ? both.along : Vector3(frame.row(0));
    const Vector3 normal = is_sector ? both.normal : Vector3(frame.row(2));
    boxes_[node] = corners.oriented<double>(along, normal.cross(along));
  }
}

}  // namespace limitsurf
