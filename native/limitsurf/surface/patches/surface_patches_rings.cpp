// SPDX-License-Identifier: Apache-2.0
//
// What the cores around one extraordinary vertex have in common.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/pi.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/patches/surface_patches_data.h"

namespace limitsurf {
namespace {

/// The cube of the number of a core's points over this is the number of cores from which on it
/// pays to make their CoreNormal.
constexpr int kWorth = 300;
/// The cosine of the angle between the normals of a core and of what many steps leave of it is at
/// least this where coreNormal() is of use.
constexpr double kLeastCosine = 0.7;

/// Whether all faces of a ring have the same form but for a turn.
bool turns(const Ring& ring) { return ring.closed() && ring.kind != RingKind::dart; }

/// The number of a ring's point after a turn by some faces.
int turnedPoint(const Ring& ring, int faces, int point) {
  if (point == 0 || point > 2 * ring.faces) {
    return point;
  }
  const int first = point < ring.face(0) ? ring.edge(0) : ring.face(0);
  return first + (point - first + faces) % ring.faces;
}

}  // namespace

SurfacePatches::CoreKind SurfacePatches::coreKind(const SurfacePiece& core) const {
  const RingTile& tile = data_->ringTile(core);
  const Eigenbasis* basis = data_->table.rings[tile.ring].basis.get();
  return {basis, turns(basis->ring()) ? 0 : tile.face};
}

std::map<SurfacePatches::CoreKind, int> SurfacePatches::coreKinds() const {
  std::map<CoreKind, int> counts;
  for (const RingTile& tile : data_->table.ring_tiles) {
    const Eigenbasis& basis = *data_->table.rings[tile.ring].basis;
    if (basis.ring().faces <= kFewFaces) {
      ++counts[{&basis, turns(basis.ring()) ? 0 : tile.face}];
    }
  }
  return counts;
}

bool SurfacePatches::corePoints(const SurfacePiece& core, Padded points[kMostCorePoints]) const {
  const RingTile& tile = data_->ringTile(core);
  const Eigenbasis& basis = *data_->table.rings[tile.ring].basis;
  const Ring& ring = basis.ring();
  if (ring.faces > kFewFaces || tile.ring_steps > data_->keptSteps(tile.ring)) {
    return false;
  }
  const bool turned = turns(ring);
  const Padded* of_ring = data_->ringPoints(tile.ring, tile.ring_steps);
  for (int i = 0; i < ring.size(); ++i) {
    points[i] = data_->scale * of_ring[turned ? turnedPoint(ring, tile.face, i) : i];
  }
  const Pose::OuterPoints outer =
      data_->pose.outerPoints(static_cast<int>(data_->tiles[core.tile].ref.index));
  const std::size_t outer_count = basis.outerModes(tile.face).slots().size();
  for (std::size_t i = 0; i < outer_count; ++i) {
    points[static_cast<std::size_t>(ring.size()) + i] = data_->scale * outer.points[i];
  }
  return true;
}

void SurfacePatches::prepareCoreNormals() {
  for (const auto& [kind, count] : coreKinds()) {
    const int size = kind.first->ring().size() + tile_grid::kOuter;
    if (count >= size * size * size / kWorth) {
      data_->core_normals.emplace(kind, CoreNormal(*kind.first, kind.second));
    }
  }
}

bool SurfacePatches::coreNormal(const SurfacePiece& core, CoreNormal::Value& out) const {
  const auto found = data_->core_normals.find(coreKind(core));
  Padded points[kMostCorePoints];
  if (found == data_->core_normals.end() || !corePoints(core, points)) {
    return false;
  }
  const RingTile& tile = data_->ringTile(core);
  const Ring& ring = data_->table.rings[tile.ring].basis->ring();
  out = found->second.value(points);
  const int corners[4] = {0, ring.edge(tile.face), ring.face(tile.face), ring.nextEdge(tile.face)};
  // The normal of the quad of control points next to the vertex, at one of its corners.
  const auto normalAt = [&](const Padded* level, int corner) -> Vector3 {
    const auto along = [&](int other) -> Vector3 {
      const Padded& end = level[corners[(corner + other) % 4]];
      return (data_->scale * (end - level[corners[corner]])).head<3>().matrix();
    };
    return along(1).cross(along(3));
  };
  const int deepest = data_->keptSteps(tile.ring);
  const Vector3 left = normalAt(data_->ringPoints(tile.ring, deepest), 0);
  if (!(out.normal.dot(left) >= kLeastCosine * out.normal.norm() * left.norm())) {
    return false;
  }
  // The surface may turn over and back again in between, as on a mesh that is folded in a plane.
  for (int step = tile.ring_steps + core.steps; step < deepest; ++step) {
    const Padded* level = data_->ringPoints(tile.ring, step);
    for (int corner = 0; corner < 4; ++corner) {
      if (!(out.normal.dot(normalAt(level, corner)) > 0)) {
        return false;
      }
    }
  }
  return true;
}

int SurfacePatches::ringCount() const { return static_cast<int>(data_->table.rings.size()); }

int SurfacePatches::ringOf(const SurfacePiece& core) const { return data_->ringTile(core).ring; }

int SurfacePatches::ringFace(const SurfacePiece& core) const { return data_->ringTile(core).face; }

int SurfacePatches::ringLevel(const SurfacePiece& core) const {
  return core.steps + data_->ringTile(core).ring_steps;
}

Eigen::Matrix3d SurfacePatches::ringFrame(int ring) const { return data_->ringHull(ring).frame; }

double SurfacePatches::ringAsymmetry(const std::vector<SurfacePiece>& cores, double enough) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (cores.empty()) {
    return kNone;
  }
  const int ring_index = ringOf(cores[0]);
  const Ring& ring = data_->table.rings[ring_index].basis->ring();
  if (ring.kind != RingKind::interior || static_cast<int>(cores.size()) != ring.faces) {
    return kNone;
  }
  const Eigen::Matrix3d& frame = data_->ringHull(ring_index).frame;
  Padded first[tile_grid::kSlots], grid[tile_grid::kSlots];
  data_->nextGrid(cores[0], false, first);
  // The frame's last axis may point to either side, so that the faces turn either way around it.
  double apart[2] = {0, 0};
  for (std::size_t i = 1; i < cores.size(); ++i) {
    data_->nextGrid(cores[i], false, grid);
    const double angle = 2 * kPi<double> * (ringFace(cores[i]) - ringFace(cores[0])) / ring.faces;
    for (int way = 0; way < 2; ++way) {
      const Eigen::Matrix3d turn =
          frame.transpose() *
          Eigen::AngleAxisd(way == 0 ? angle : -angle, Vector3::UnitZ()).toRotationMatrix() * frame;
      for (int c = 0; c < tile_grid::kSlots; ++c) {
        if (tile_grid::exists(Sides::inner, c)) {
          const Vector3 turned = turn * first[c].head<3>().matrix();
          apart[way] = std::max(apart[way], (turned - grid[c].head<3>().matrix()).norm());
        }
      }
    }
    if (!(data_->scale * std::min(apart[0], apart[1]) < enough)) {
      return kNone;
    }
  }
  return data_->scale * std::min(apart[0], apart[1]);
}

}  // namespace limitsurf
