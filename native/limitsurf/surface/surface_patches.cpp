// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/surface_patches.h"

#include <cmath>

#include "limitsurf/surface/bezier_conversion.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/surface_data_poses.h"

namespace limitsurf {
namespace {

/// The quad's own square, turned so that its corner `corner` comes first.
FaceRectangle turned(const FaceRectangle& on, int corner) {
  switch (corner & 3) {
    case 0:
      return on;
    case 1:  // s runs along the old t, t against the old s
      return {on.face, on.u0 + on.us, on.ut, -on.us, on.v0 + on.vs, on.vt, -on.vs};
    case 2:
      return {on.face, on.u0 + on.us + on.ut, -on.us, -on.ut, on.v0 + on.vs + on.vt, -on.vs,
              -on.vt};
    default:
      return {on.face, on.u0 + on.ut, -on.ut, on.us, on.v0 + on.vt, -on.vt, on.vs};
  }
}

/// The quarters of a core in the order of SplitCore.
constexpr int kQuarters[3][2] = {{1, 0}, {1, 1}, {0, 1}};

}  // namespace

struct SurfacePatches::Data {
  struct Tile {
    TileRef ref;
    FaceRectangle on;  ///< of a ring tile turned so that its vertex is (0, 0)
  };

  Data(const TileTable& tile_table, const Pose& control_points)
      : table(tile_table), pose(control_points) {
    for (int i = 0; i < table.points.cagePoints(); ++i) {
      cage_box.include(pose.point(i).head<3>().matrix());
    }
    tiles.reserve(table.faces.size());
    for (std::size_t face = 0; face < table.faces.size(); ++face) {
      FaceRectangle whole;
      whole.face = static_cast<int>(face);
      addTiles(table.faces[face], whole);
    }
  }

  void addTiles(const TileRef& ref, const FaceRectangle& on) {
    switch (ref.kind) {
      case TileRef::kNone:
        return;
      case TileRef::kSplit:
        for (int c = 0; c < 4; ++c) {
          addTiles(table.splits[ref.index][c], turned(on, c).part(0, 0, 0.5, 0.5));
        }
        return;
      case TileRef::kBSpline:
        tiles.push_back({ref, on});
        return;
      default:
        tiles.push_back({ref, turned(on, table.ring_tiles[ref.index].corner)});
    }
  }

  /// Up to which step a ring's points are kept.
  int keptSteps(int ring) const {
    return table.rings[ring].basis->ring().faces > kFewFaces ? kMostSteps : kFewSteps;
  }

  void setLevels(int threads) {
    radii.resize(table.rings.size() * (kMostSteps + 1));
    first_level.resize(table.rings.size());
    std::size_t size = 0;
    for (std::size_t ring = 0; ring < table.rings.size(); ++ring) {
      first_level[ring] = size;
      size += table.rings[ring].points.size() * (keptSteps(static_cast<int>(ring)) + 1);
    }
    levels.resize(size);
    parallelFor(table.rings.size(), 16, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t ring = begin; ring < end; ++ring) {
        setRingLevels(static_cast<int>(ring));
      }
    });
  }

  /// How far a ring's points are from its limit after 0, 1, ... steps, and the
  /// points.
  void setRingLevels(int ring_index) {
    const RingPoints& ring = table.rings[ring_index];
    const Padded limit = pose.ring(ring_index).limit;
    std::vector<Padded> points(ring.points.size()), next(ring.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = (pose.point(ring.points[i]) - limit) + pose.residual(ring.points[i]);
    }
    const int kept_steps = keptSteps(ring_index);
    float* out = &radii[static_cast<std::size_t>(ring_index) * (kMostSteps + 1)];
    for (int step = 0; step <= kMostSteps; ++step) {
      double squared = 0;
      for (const Padded& point : points) {
        squared = std::max(squared, point.square().sum());
      }
      out[step] = static_cast<float>(std::sqrt(squared) * (1 + kFloatMargin));
      if (step <= kept_steps) {
        std::copy(points.begin(), points.end(),
                  &levels[first_level[ring_index] + points.size() * step]);
      }
      ring.basis->step().apply([&](int i) -> const Padded& { return points[i]; },
                               [&](int i) -> Padded& { return next[i]; });
      points.swap(next);
    }
  }

  const RingTile& ringTile(const SurfacePiece& piece) const {
    return table.ring_tiles[tiles[piece.tile].ref.index];
  }

  double radius(const SurfacePiece& core) const {
    const RingTile& tile = ringTile(core);
    return radii[static_cast<std::size_t>(tile.ring) * (kMostSteps + 1) +
                 std::min(core.steps + tile.ring_steps, kMostSteps)];
  }

  FaceRectangle rectangle(const SurfacePiece& piece) const {
    const Tile& tile = tiles[piece.tile];
    if (tile.ref.kind == TileRef::kRing) {
      const double size = powerOfTwo(-piece.steps);
      if (piece.isCore()) {
        return tile.on.part(0, 0, size, size);
      }
      const int* quarter = kQuarters[piece.part];
      return tile.on.part(quarter[0] * size, quarter[1] * size, size, size);
    }
    const TileStrips::Strip s = TileStrips(table.bsplines[tile.ref.index]).at(piece.part);
    return tile.on.part(s.u0, s.v0, s.u1 - s.u0, s.v1 - s.v0);
  }

  void regularPatch(const SurfacePiece& piece, BezierPatch& out) const {
    const BSplineTile& tile = table.bsplines[tiles[piece.tile].ref.index];
    out.anchor = pose.point(tile.points[5]);
    if (tile.crease > 0) {
      stripPatch(tile, piece.part, out);
      return;
    }
    for (int i = 0; i < 16; ++i) {
      out.points[i] = pose.difference(tile.points[i], tile.points[5]);
    }
    continueSides(out.points, tile.x_low, tile.x_high, tile.y_low, tile.y_high);
    convertBothWays(out.points, toBezier);
    out.borders = (tile.x_low ? kSideS0 : 0u) | (tile.x_high ? kSideS1 : 0u) |
                  (tile.y_low ? kSideT0 : 0u) | (tile.y_high ? kSideT1 : 0u);
  }

  /// A strip along a semi-sharp edge, from its values: its weights are known, not its points.
  void stripPatch(const BSplineTile& tile, int strip, BezierPatch& out) const {
    Padded window[16];
    for (int i = 0; i < 16; ++i) {
      window[i] = pose.difference(tile.points[i], tile.points[5]);
    }
    const TileStrips::Strip s = TileStrips(tile).at(strip);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const TileWeights w(tile, s.u0 + (s.u1 - s.u0) * x / 3, s.v0 + (s.v1 - s.v0) * y / 3);
        PatchValues<Padded> patch;
        evaluateWindow<0>(window, 4, w.u, w.v, patch);
        out.points[4 * y + x] = patch.value;
      }
    }
    convertBothWays(out.points, interpolateBezier);
    out.borders =
        (tile.x_low && s.u0 == 0 ? kSideS0 : 0u) | (tile.x_high && s.u1 == 1 ? kSideS1 : 0u) |
        (tile.y_low && s.v0 == 0 ? kSideT0 : 0u) | (tile.y_high && s.v1 == 1 ? kSideT1 : 0u);
  }

  /// A ring tile's control grid after `steps` >= 1 steps, relative to the anchor that is returned.
  Padded ringGrid(const SurfacePiece& piece, int steps, Padded grid[tile_grid::kSlots]) const {
    const int index = static_cast<int>(tiles[piece.tile].ref.index);
    const RingTile& tile = table.ring_tiles[index];
    if (steps <= pose.gridSteps(tile)) {
      const Pose::Grid& kept = pose.grid(index, steps);
      std::copy(kept.points, kept.points + tile_grid::kSlots, grid);
      return kept.limit();
    }
    const Pose::RingPose& ring = pose.ring(tile.ring);
    table.rings[tile.ring].basis->controlGrid(tile.face, steps, tile.ring_steps, ring.coefficients,
                                              pose.ringTile(index).outer, grid);
    const double scale = powerOfTwo(1 - steps);
    for (int c = 0; c < tile_grid::kSlots; ++c) {
      grid[c] = scale * grid[c] + ring.constant();
    }
    return ring.limit;
  }

  /// The same, for a core that is split step by step: `grid` holds that before the core's last step
  /// if `chained`.
  Padded nextGrid(const SurfacePiece& core, bool chained, Padded grid[tile_grid::kSlots]) const {
    const RingTile& tile = ringTile(core);
    const int steps = core.steps + 1;
    const std::size_t first = first_level[tile.ring];
    const int kept = keptSteps(tile.ring);
    if (steps <= pose.gridSteps(tile) || (kept < kMostSteps && steps + tile.ring_steps > kept)) {
      return ringGrid(core, steps, grid);
    }
    const RingPoints& ring = table.rings[tile.ring];
    int done = core.steps;
    if (!chained) {
      done = pose.gridSteps(tile);
      ringGrid(core, done, grid);
    }
    Padded after[tile_grid::kSlots];
    std::fill_n(after, tile_grid::kSlots, Padded::Zero());
    for (; done < steps; ++done) {
      const std::size_t level = std::min(done + 1 + tile.ring_steps, kMostSteps);
      stepGrid(ring.basis->ring(), tile.face, &levels[first + ring.points.size() * level], grid,
               after);
      std::copy(after, after + tile_grid::kSlots, grid);
    }
    return pose.ring(tile.ring).limit;
  }

  void quarterPatch(const RingTile& tile, const Padded* grid, int steps, int quarter,
                    BezierPatch& out) const {
    const int a = kQuarters[quarter][0], b = kQuarters[quarter][1];
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        out.points[4 * y + x] = grid[(b + y) * tile_grid::kSize + a + x];
      }
    }
    const bool x_low = onRight(tile.sides) && a == 0, y_low = onLeft(tile.sides) && b == 0;
    continueSides(out.points, x_low, false, y_low, false);
    convertBothWays(out.points, toBezier);
    out.borders = (x_low ? kSideS0 : 0u) | (y_low ? kSideT0 : 0u) |
                  (tile.u_high && steps == 1 && a == 1 ? kSideS1 : 0u) |
                  (tile.v_high && steps == 1 && b == 1 ? kSideT1 : 0u);
  }

  static constexpr double kFloatMargin = 1e-6;
  static constexpr int kFewSteps = 12;

  const TileTable& table;
  const Pose& pose;
  std::vector<Tile> tiles;
  std::vector<float> radii;              // kMostSteps + 1 of each ring
  std::vector<std::size_t> first_level;  // of each ring
  std::vector<Padded> levels;            // relative to the rings' limits
  Box cage_box;
};

SurfacePatches::SurfacePatches(const LimitSurface& surface, int threads)
    : data_(std::make_unique<Data>(surface.data_->table, surface.data_->pose)) {
  data_->setLevels(threads);
}
SurfacePatches::SurfacePatches(const SurfaceData& data, int threads)
    : data_(std::make_unique<Data>(data.data_->tiles->table, data.data_->poses.front())) {
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
    out.anchor = data_->ringGrid(piece, piece.steps, grid);
    data_->quarterPatch(data_->ringTile(piece), grid, piece.steps, piece.part, out);
  } else {
    data_->regularPatch(piece, out);
  }
  out.on = data_->rectangle(piece);
  return out;
}

void SurfacePatches::split(const SurfacePiece& core, SplitCore& out) const {
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
    patch.on = data_->rectangle(out.pieces[quarter]);
  }
  out.core = {core.tile, static_cast<std::int16_t>(steps), SurfacePiece::kCore};
  // The points that decide about the rest: the ring's, and the slots around its own square.
  const Vector3 vertex = coreVertex(core), reach = Vector3::Constant(data_->radius(out.core));
  out.core_box = {vertex - reach, vertex + reach};
  for (const int c : tile_grid::kOuterSlots) {
    if (tile_grid::exists(tile.sides, c)) {
      out.core_box.include((anchor + grid[c]).head<3>().matrix());
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
  const Pose::RingTilePose& outer = pose.ringTile(data_->tiles[core.tile].ref.index);
  const std::size_t count =
      data_->table.rings[tile.ring].basis->outerModes(tile.face).slots().size();
  for (std::size_t i = 0; i < count; ++i) {
    box.include((pose.ring(tile.ring).limit + outer.outer[i]).head<3>().matrix());
  }
  return box;
}

double SurfacePatches::coreRadius(const SurfacePiece& core) const { return data_->radius(core); }

Vector3 SurfacePatches::coreVertex(const SurfacePiece& core) const {
  return data_->pose.ring(data_->ringTile(core).ring).limit.head<3>().matrix();
}

double SurfacePatches::diagonal() const {
  return data_->table.faces.empty() ? 0 : (data_->cage_box.high - data_->cage_box.low).norm();
}

Vector3 SurfacePatches::middle() const { return (data_->cage_box.low + data_->cage_box.high) / 2; }

}  // namespace limitsurf
