// SPDX-License-Identifier: Apache-2.0
//
// The tiles of a surface, their rings' points after every step, and patches made from both.
#include "limitsurf/surface/patches/surface_patches_data.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limitsurf/eigen/ring_shrinkage.h"
#include "limitsurf/float_rounding.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/batch/grid_step.h"
#include "limitsurf/surface/bezier_conversion.h"
#include "limitsurf/surface/tile_weights.h"

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

/// If the sine of the angle between two vectors is smaller, they do not span a plane well enough.
constexpr double kLeastSine = 1e-6;
/// The rounding of the coordinates of a point in a frame, of its largest coordinate: three products
/// and two sums, each of at most sqrt(3) times that.
constexpr double kTurnRounding = 9 * 0x1p-53;

/// The quarters of a core in the order of SplitCore.
constexpr int kQuarters[3][2] = {{1, 0}, {1, 1}, {0, 1}};

}  // namespace

SurfacePatches::Data::Data(const TileTable& tile_table, const Pose& control_points,
                           PatchUnit patch_unit)
    : table(tile_table), pose(control_points) {
  for (int i = 0; i < table.points.cagePoints(); ++i) {
    cage_box.include(pose.point(i).head<3>().matrix());
  }
  if (!table.faces.empty()) {
    const Vector3 size = cage_box.high - cage_box.low;
    const double to_unit = scaleToOwnUnit(size.maxCoeff());  // small squares would vanish
    diagonal = (to_unit * size).norm() / to_unit;
  }
  unit = 1 / scaleToOwnUnit(diagonal);
  scale = patch_unit == PatchUnit::own ? 1 / unit : 1;
  tiles.reserve(table.bsplines.size() + table.ring_tiles.size());
  InterruptionStride stride;
  for (std::size_t face = 0; face < table.faces.size(); ++face) {
    stride.step();
    FaceRectangle whole;
    whole.face = static_cast<int>(face);
    addTiles(table.faces[face], whole);
  }
}

void SurfacePatches::Data::addTiles(const TileRef& ref, const FaceRectangle& on) {
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

int SurfacePatches::Data::keptSteps(int ring) const {
  return table.rings[ring].basis->ring().faces > kFewFaces ? kMostSteps : kFewSteps;
}

int SurfacePatches::Data::flatSteps(int ring) const {
  return std::max(keptSteps(ring), kFlatSteps);
}

void SurfacePatches::Data::setLevels(int threads) {
  radii.resize(table.rings.size() * (kMostSteps + 1));
  first_level.resize(table.rings.size());
  hulls_ = std::make_unique<FirstMade<RingHull>[]>(table.rings.size());
  std::size_t size = 0;
  for (std::size_t ring = 0; ring < table.rings.size(); ++ring) {
    first_level[ring] = size;
    const int kept = keptSteps(static_cast<int>(ring));
    size += table.rings[ring].points.size() * static_cast<std::size_t>(kept + 1);
    const Eigenbasis* basis = table.rings[ring].basis.get();
    if (kept < kMostSteps && shrinkages_.count(basis) == 0) {
      shrinkages_[basis] = ringShrinkage(*basis, kMostSteps - kept);
    }
  }
  levels.resize(size);
  parallelFor(table.rings.size(), kRingsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t ring = begin; ring < end; ++ring) {
      setRingLevels(static_cast<int>(ring));
    }
  });
}

std::pair<Vector3, Vector3> SurfacePatches::Data::planeOf(int ring) const {
  const Eigenbasis& basis = *table.rings[ring].basis;
  if (basis.ring().kind == RingKind::interior) {
    // Ring points approach the plane of the two modes with the largest eigenvalues below 1.
    int first = 1, second = 2;
    for (int mode = 2; mode < basis.modeCount(); ++mode) {
      if (basis.eigenvalue(mode) > basis.eigenvalue(first)) {
        second = std::exchange(first, mode);
      } else if (mode > 2 && basis.eigenvalue(mode) > basis.eigenvalue(second)) {
        second = mode;
      }
    }
    const Points& coefficients = pose.ring(ring).coefficients;
    return {coefficients.row(first), coefficients.row(second)};
  }
  const std::size_t count = table.rings[ring].points.size();
  const Padded* points =
      &levels[first_level[ring] + count * static_cast<std::size_t>(keptSteps(ring))];
  const auto farthest = [&](const auto& measure) {
    std::size_t found = 0;
    double most = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = measure(Vector3(points[i].head<3>()));
      if (value > most) {
        most = value;
        found = i;
      }
    }
    return Vector3(points[found].head<3>());
  };
  const Vector3 along = farthest([](const Vector3& p) { return p.cwiseAbs().maxCoeff(); });
  const Vector3 direction = along.stableNormalized();
  return {along,
          farthest([&](const Vector3& p) { return direction.cross(p).cwiseAbs().maxCoeff(); })};
}

Eigen::Matrix3d SurfacePatches::Data::frameOf(int ring) const {
  const auto [first, second] = planeOf(ring);
  const Vector3 along = first.stableNormalized(), across = second.stableNormalized();
  Vector3 normal = along.cross(across);
  if (!(normal.norm() > kLeastSine)) {
    return Eigen::Matrix3d::Identity();
  }
  // Where the sine is small, rounding has left some of the first direction in the product.
  normal.normalize();
  normal = (normal - normal.dot(along) * along).normalized();
  Eigen::Matrix3d axes;
  axes.row(0) = along;
  axes.row(2) = normal;
  axes.row(1) = normal.cross(along);
  return axes;
}

std::unique_ptr<SurfacePatches::Data::RingHull> SurfacePatches::Data::makeHull(int ring) const {
  auto hull = std::make_unique<RingHull>();
  hull->frame = frameOf(ring);
  hull->extents.reserve(static_cast<std::size_t>(flatSteps(ring) + 1));
  const std::size_t count = table.rings[ring].points.size();
  const Padded* points = &levels[first_level[ring]];
  const int kept = keptSteps(ring);
  for (int step = 0; step <= kept; ++step, points += count) {
    hull->extents.push_back(extentOf(points, count, hull->frame));
  }
  std::vector<Padded> last(points - count, points), next(count);
  for (int step = kept + 1; step <= flatSteps(ring); ++step) {
    table.rings[ring].basis->step().apply([&](int i) -> const Padded& { return last[i]; },
                                          [&](int i) -> Padded& { return next[i]; });
    last.swap(next);
    hull->extents.push_back(extentOf(last.data(), count, hull->frame));
  }
  return hull;
}

SurfacePatches::Data::Extent SurfacePatches::Data::extentOf(const Padded* points, std::size_t count,
                                                            const Eigen::Matrix3d& frame) const {
  Padded axes[3];  // a coordinate of all three in each
  for (int i = 0; i < 3; ++i) {
    axes[i] << frame.col(i).array(), 0;
  }
  // The limit, 0, is in the hull, but for rounding.
  Padded low = Padded::Zero(), high = low;
  for (std::size_t i = 0; i < count; ++i) {
    const Padded turned = points[i][0] * axes[0] + points[i][1] * axes[1] + points[i][2] * axes[2];
    low = low.min(turned);
    high = high.max(turned);
  }
  const double margin = kTurnRounding * std::max(-low.minCoeff(), high.maxCoeff());
  Extent extent;
  for (int axis = 0; axis < 3; ++axis) {
    extent.low[axis] = roundedDown((low[axis] - margin) / unit);
    extent.high[axis] = roundedUp((high[axis] + margin) / unit);
  }
  return extent;
}

CoreHull SurfacePatches::Data::hull(const SurfacePiece& core, const Padded* grid) const {
  const RingTile& tile = ringTile(core);
  const RingHull& of_ring = ringHull(tile.ring);
  CoreHull hull;
  hull.vertex = pose.ring(tile.ring).limit.head<3>();
  hull.axes = of_ring.frame;
  // Later points lie in the hull of earlier ones.
  const int step = core.steps + tile.ring_steps;
  const int flat = std::min(step, flatSteps(tile.ring));
  const Extent& extent = of_ring.extents[static_cast<std::size_t>(flat)];
  const double reach = radius(core);
  for (int axis = 0; axis < 3; ++axis) {
    hull.low[axis] = std::max(unit * extent.low[axis], -reach);
    hull.high[axis] = std::min(unit * extent.high[axis], reach);
  }
  // Grids are relative to the vertex.
  for (const int c : tile_grid::kOuterSlots) {
    if (tile_grid::exists(tile.sides, c)) {
      const Vector3 turned = hull.axes * grid[c].head<3>().matrix();
      hull.low = hull.low.cwiseMin(turned);
      hull.high = hull.high.cwiseMax(turned);
    }
  }
  return hull;
}

void SurfacePatches::Data::setRingLevels(int ring_index) {
  const RingPoints& ring = table.rings[ring_index];
  const Padded limit = pose.ring(ring_index).limit;
  std::vector<Padded> points(ring.points.size()), next(ring.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = (pose.point(ring.points[i]) - limit) + pose.residual(ring.points[i]);
  }
  const int kept_steps = keptSteps(ring_index);
  float* out = &radii[static_cast<std::size_t>(ring_index) * (kMostSteps + 1)];
  double radius = 0;
  for (int step = 0; step <= kept_steps; ++step) {
    if (step > 0) {
      ring.basis->step().apply([&](int i) -> const Padded& { return points[i]; },
                               [&](int i) -> Padded& { return next[i]; });
      points.swap(next);
    }
    double squared = 0;
    for (const Padded& point : points) {
      squared = std::max(squared, point.square().sum());
    }
    radius = std::sqrt(squared) / unit * (1 + kFloatMargin);
    out[step] = static_cast<float>(radius);
    std::copy(points.begin(), points.end(),
              &levels[first_level[ring_index] + points.size() * step]);
  }
  if (kept_steps < kMostSteps) {
    const std::vector<double>& shrinkage = shrinkages_.at(ring.basis.get());
    for (int step = kept_steps + 1; step <= kMostSteps; ++step) {
      out[step] = static_cast<float>(radius * shrinkage[step - kept_steps]);
    }
  }
}

double SurfacePatches::Data::radius(const SurfacePiece& core) const {
  const RingTile& tile = ringTile(core);
  return unit * radii[static_cast<std::size_t>(tile.ring) * (kMostSteps + 1) +
                      std::min(core.steps + tile.ring_steps, kMostSteps)];
}

FaceRectangle SurfacePatches::Data::rectangle(const SurfacePiece& piece) const {
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

void SurfacePatches::Data::regularPatch(const SurfacePiece& piece, BezierPatch& out) const {
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
  convertBothWays(out.points, toBezier<Padded>);
  out.borders = (tile.x_low ? kSideS0 : 0u) | (tile.x_high ? kSideS1 : 0u) |
                (tile.y_low ? kSideT0 : 0u) | (tile.y_high ? kSideT1 : 0u);
}

/// A strip along a semi-sharp edge, interpolated from its values: its Bezier points have no direct
/// formula, but its weights have.
void SurfacePatches::Data::stripPatch(const BSplineTile& tile, int strip, BezierPatch& out) const {
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

Padded SurfacePatches::Data::ringGrid(const SurfacePiece& piece, int steps,
                                      Padded grid[tile_grid::kSlots]) const {
  const int index = static_cast<int>(tiles[piece.tile].ref.index);
  const RingTile& tile = table.ring_tiles[index];
  if (steps <= pose.gridSteps(tile)) {
    Pose::OwnGrids own;
    const Pose::Grid& kept = pose.grids(index, steps, own)[steps - 1];
    std::copy(kept.points, kept.points + tile_grid::kSlots, grid);
    return kept.limit();
  }
  const Pose::RingPose& ring = pose.ring(tile.ring);
  table.rings[tile.ring].basis->controlGrid(tile.face, steps, tile.ring_steps, ring.coefficients,
                                            pose.outerPoints(index).points, grid);
  const double shrinkage = powerOfTwo(1 - steps);
  for (int c = 0; c < tile_grid::kSlots; ++c) {
    grid[c] = shrinkage * grid[c] + ring.constant();
  }
  return ring.limit;
}

Padded SurfacePatches::Data::nextGrid(const SurfacePiece& core, bool chained,
                                      Padded grid[tile_grid::kSlots]) const {
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
  const GridStep step(ring.basis->ring(), tile.face);
  for (; done < steps; ++done) {
    const std::size_t level = std::min(done + 1 + tile.ring_steps, kMostSteps);
    step.apply(&levels[first + ring.points.size() * level], grid, after);
    std::copy(after, after + tile_grid::kSlots, grid);
  }
  return pose.ring(tile.ring).limit;
}

void SurfacePatches::Data::quarterPatch(const RingTile& tile, const Padded* grid, int steps,
                                        int quarter, BezierPatch& out) const {
  const int a = kQuarters[quarter][0], b = kQuarters[quarter][1];
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      out.points[4 * y + x] = grid[(b + y) * tile_grid::kSize + a + x];
    }
  }
  const bool x_low = onRight(tile.sides) && a == 0, y_low = onLeft(tile.sides) && b == 0;
  continueSides(out.points, x_low, false, y_low, false);
  convertBothWays(out.points, toBezier<Padded>);
  out.borders = (x_low ? kSideS0 : 0u) | (y_low ? kSideT0 : 0u) |
                (tile.u_high && steps == 1 && a == 1 ? kSideS1 : 0u) |
                (tile.v_high && steps == 1 && b == 1 ? kSideT1 : 0u);
}

}  // namespace limitsurf
