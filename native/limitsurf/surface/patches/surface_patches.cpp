// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/patches/surface_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/patches/surface_patches_data.h"
#include "limitsurf/surface/surface_data_poses.h"
#include "limitsurf/surface/tile_weights.h"

namespace limitsurf {

namespace {

void multiply(BezierPatch& patch, double scale) {
  if (scale == 1) {
    return;
  }
  patch.anchor *= scale;
  for (BezierPatch::Point& point : patch.points) {
    point *= scale;
  }
}

}  // namespace

SurfacePatches::SurfacePatches(const LimitSurface& surface, int threads, PatchUnit unit)
    : data_(std::make_unique<Data>(surface.data_->table, surface.data_->pose, unit)) {
  data_->setLevels(threads);
}
SurfacePatches::SurfacePatches(const SurfaceData& data, int threads, Eigen::Index first_column,
                               PatchUnit unit)
    : data_(std::make_unique<Data>(
          data.data_->tiles->table,
          data.data_
              ->poses[static_cast<std::size_t>(first_column / SurfaceData::Data::kColumnsPerPose)],
          unit)) {
  data_->setLevels(threads);
}
SurfacePatches::~SurfacePatches() = default;
SurfacePatches::SurfacePatches(SurfacePatches&&) noexcept = default;
SurfacePatches& SurfacePatches::operator=(SurfacePatches&&) noexcept = default;

int SurfacePatches::tileCount() const { return static_cast<int>(data_->tiles.size()); }

int SurfacePatches::pieceCount(int tile) const {
  const TileRef& ref = data_->tiles[tile].ref;
  return ref.kind == TileRef::kRing ? 1 : TileStrips(data_->table.bsplines[ref.index]).count;
}

void SurfacePatches::appendPieces(int tile, std::vector<SurfacePiece>& pieces) const {
  if (data_->tiles[tile].ref.kind == TileRef::kRing) {
    pieces.push_back({tile, 0, SurfacePiece::kCore});
    return;
  }
  const int count = pieceCount(tile);
  for (int strip = 0; strip < count; ++strip) {
    pieces.push_back({tile, 0, static_cast<std::int16_t>(strip)});
  }
}

FaceRectangle SurfacePatches::rectangle(const SurfacePiece& piece) const {
  return data_->rectangle(piece);
}

BezierPatch SurfacePatches::patch(const SurfacePiece& piece) const {
  BezierPatch out;
  if (piece.steps > 0) {
    Padded grid[tile_grid::kSlots];
    SurfacePiece core = piece;
    --core.steps;
    out.anchor = data_->nextGrid(core, false, grid);
    data_->quarterPatch(data_->ringTile(piece), grid, piece.steps, piece.part, out);
  } else {
    data_->regularPatch(piece, out);
  }
  multiply(out, data_->scale);
  out.on = data_->rectangle(piece);
  return out;
}

void SurfacePatches::splitPatches(const SurfacePiece& core, SplitCore& out) const {
  const int steps = core.steps + 1;
  const RingTile& tile = data_->ringTile(core);
  static_assert(sizeof out.grid_ == sizeof(Padded) * tile_grid::kSlots);
  const bool chained = core.steps > 0 && out.core.tile == core.tile && out.core.steps == core.steps;
  Padded* grid = out.grid_;
  const Padded anchor = data_->nextGrid(core, chained, grid);
  for (int quarter = 0; quarter < 3; ++quarter) {
    out.pieces[quarter] = {core.tile, static_cast<std::int16_t>(steps),
                           static_cast<std::int16_t>(quarter)};
    BezierPatch& patch = out.patches[quarter];
    patch.anchor = anchor;
    data_->quarterPatch(tile, grid, steps, quarter, patch);
    multiply(patch, data_->scale);
  }
  out.core = {core.tile, static_cast<std::int16_t>(steps), SurfacePiece::kCore};
}

void SurfacePatches::split(const SurfacePiece& whole, SplitCore& out) const {
  const SurfacePiece core = whole;  // which may be the one that is set
  splitPatches(core, out);
  for (int quarter = 0; quarter < 3; ++quarter) {
    out.patches[quarter].on = data_->rectangle(out.pieces[quarter]);
  }
  const RingTile& tile = data_->ringTile(core);
  const Padded* grid = out.grid_;
  const Padded anchor = data_->pose.ring(tile.ring).limit;
  // The rest lies in the convex hull of the ring's points and of the slots around its own square.
  const Vector3 vertex = coreVertex(core), reach = Vector3::Constant(coreRadius(out.core));
  out.core_box = {vertex - reach, vertex + reach};
  for (const int c : tile_grid::kOuterSlots) {
    if (tile_grid::exists(tile.sides, c)) {
      out.core_box.include(data_->scale * (anchor + grid[c]).head<3>().matrix());
    }
  }
}

CoreHull SurfacePatches::restHull(const SplitCore& split) const {
  CoreHull hull = data_->hull(split.core, split.grid_);
  hull.vertex *= data_->scale;
  hull.low *= data_->scale;
  hull.high *= data_->scale;
  return hull;
}

void SurfacePatches::appendRestPoints(const SplitCore& split, std::vector<Padded>& points) const {
  const RingTile& tile = data_->ringTile(split.core);
  const Padded anchor = data_->pose.ring(tile.ring).limit;
  const int step = std::min(split.core.steps + tile.ring_steps, data_->keptSteps(tile.ring));
  const Padded* of_ring = data_->ringPoints(tile.ring, step);
  const auto append = [&](const Padded& point) {
    points.push_back(data_->scale * (anchor + point));
  };
  for (std::size_t i = 0; i < data_->table.rings[tile.ring].points.size(); ++i) {
    append(of_ring[i]);
  }
  for (const int c : tile_grid::kOuterSlots) {
    if (tile_grid::exists(tile.sides, c)) {
      append(split.grid_[c]);
    }
  }
}

Box SurfacePatches::coreBox(const SurfacePiece& core) const {
  const RingTile& tile = data_->ringTile(core);
  const Pose& pose = data_->pose;
  Box box;
  for (const int point : data_->table.rings[tile.ring].points) {
    box.include(pose.point(point).head<3>().matrix());
  }
  const Pose::OuterPoints outer =
      pose.outerPoints(static_cast<int>(data_->tiles[core.tile].ref.index));
  const std::size_t count =
      data_->table.rings[tile.ring].basis->outerModes(tile.face).slots().size();
  for (std::size_t i = 0; i < count; ++i) {
    box.include((pose.ring(tile.ring).limit + outer.points[i]).head<3>().matrix());
  }
  box.low *= data_->scale;
  box.high *= data_->scale;
  return box;
}

double SurfacePatches::coreRadius(const SurfacePiece& core) const {
  return data_->scale * data_->radius(core);
}

int SurfacePatches::coreValence(const SurfacePiece& core) const {
  return data_->table.rings[data_->ringTile(core).ring].basis->ring().faces;
}

bool SurfacePatches::isOnBoundaryCurve(const SurfacePiece& core) const {
  return data_->table.rings[data_->ringTile(core).ring].basis->ring().kind == RingKind::boundary;
}

Vector3 SurfacePatches::ringPitch(const SurfacePiece& core, const Eigen::Matrix3d& frame) const {
  const RingTile& tile = data_->ringTile(core);
  const int steps = core.steps + tile.ring_steps;
  if (steps > data_->keptSteps(tile.ring)) {
    return Vector3::Constant(2 * coreRadius(core));
  }
  const Padded* points = data_->ringPoints(tile.ring, steps);
  const Ring& ring = data_->table.rings[tile.ring].basis->ring();
  Vector3 pitch = Vector3::Zero();
  const auto include = [&](int a, int b) {
    pitch = pitch.cwiseMax((frame * (points[a] - points[b]).head<3>().matrix()).cwiseAbs());
  };
  const auto includeFace = [&](int face) {
    const int e = ring.edge(face), f = ring.face(face), next = ring.nextEdge(face);
    include(0, e);
    include(e, f);
    include(f, next);
    include(next, 0);
  };
  includeFace(tile.face);
  if (!onLeft(tile.sides)) {
    includeFace((tile.face + ring.faces - 1) % ring.faces);
  }
  if (!onRight(tile.sides)) {
    includeFace((tile.face + 1) % ring.faces);
  }
  return data_->scale * pitch;
}

Vector3 SurfacePatches::outerPitch(const SplitCore& split, const Eigen::Matrix3d& frame) const {
  using namespace tile_grid;
  const Sides sides = data_->ringTile(split.core).sides;
  Vector3 pitch = Vector3::Zero();
  for (const int c : kOuterSlots) {
    if (!exists(sides, c)) {
      continue;
    }
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {0, -1}, {1, 0}, {0, 1}}) {
      const int x = xOf(c) + dx, y = yOf(c) + dy;
      if (std::min(x, y) >= -1 && std::max(x, y) <= 2 && exists(sides, slot(x, y))) {
        const Padded difference = split.grid_[c] - split.grid_[slot(x, y)];
        pitch = pitch.cwiseMax((frame * difference.head<3>().matrix()).cwiseAbs());
      }
    }
  }
  return data_->scale * pitch;
}

Eigen::Matrix3d SurfacePatches::coreFrame(const SurfacePiece& core) const {
  const RingTile& tile = data_->ringTile(core);
  const Ring& ring = data_->table.rings[tile.ring].basis->ring();
  const Padded* points = data_->ringPoints(tile.ring, tile.ring_steps);
  const auto along = [&](int edge) -> Vector3 {
    return ((points[edge] - points[0]) / data_->unit).head<3>().matrix();
  };
  const Vector3 s = along(ring.edge(tile.face)), t = along(ring.nextEdge(tile.face));
  const Vector3 between = s + t, normal = s.cross(t);
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  if (between.squaredNorm() > 0 && normal.squaredNorm() > 0) {
    frame.row(0) = between.normalized();
    frame.row(2) = normal.normalized();
    frame.row(1) = frame.row(2).cross(frame.row(0));
  }
  return frame;
}

Vector3 SurfacePatches::coreVertex(const SurfacePiece& core) const {
  return data_->scale * data_->pose.ring(data_->ringTile(core).ring).limit.head<3>().matrix();
}

double SurfacePatches::diagonal() const { return data_->scale * data_->diagonal; }

Vector3 SurfacePatches::middle() const {
  return data_->scale * (data_->cage_box.low / 2 + data_->cage_box.high / 2);
}

double SurfacePatches::scale() const { return data_->scale; }

}  // namespace limitsurf
