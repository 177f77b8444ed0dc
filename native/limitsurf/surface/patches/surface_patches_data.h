// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "limitsurf/first_made.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/pose/pose.h"

namespace limitsurf {

struct SurfacePatches::Data {
  struct Tile {
    TileRef ref;
    FaceRectangle on;  ///< of a ring tile turned so that its vertex is (0, 0)
  };

  Data(const TileTable& tile_table, const Pose& control_points, PatchUnit patch_unit);

  /// Fills `radii` and `levels`.
  void setLevels(int threads);

  const RingTile& ringTile(const SurfacePiece& piece) const {
    return table.ring_tiles[tiles[piece.tile].ref.index];
  }
  /// The distance of the ring's points from its limit after the core's steps.
  double radius(const SurfacePiece& core) const;
  FaceRectangle rectangle(const SurfacePiece& piece) const;

  /// The last step for which a ring's points are kept.
  int keptSteps(int ring) const;
  /// The last step after which the extent of a ring's points is kept.
  int flatSteps(int ring) const;

  /// A ring's points after so many steps, at most keptSteps().
  const Padded* ringPoints(int ring, int steps) const {
    return &levels[first_level[ring] + table.rings[ring].points.size() * steps];
  }

  /// A piece of a regular tile.
  void regularPatch(const SurfacePiece& piece, BezierPatch& out) const;
  /// A ring tile's control grid after `steps` >= 1 steps, relative to the anchor that is returned.
  Padded ringGrid(const SurfacePiece& piece, int steps, Padded grid[tile_grid::kSlots]) const;
  /// A box around what is left of a core after its steps, of which `grid` is the control grid.
  CoreHull hull(const SurfacePiece& core, const Padded* grid) const;
  /// The grid after one step more than the core's. If `chained`, `grid` holds the one after the
  /// core's steps.
  Padded nextGrid(const SurfacePiece& core, bool chained, Padded grid[tile_grid::kSlots]) const;
  /// One of the three patches beside the core that is left after `steps` steps.
  void quarterPatch(const RingTile& tile, const Padded* grid, int steps, int quarter,
                    BezierPatch& out) const;

  const TileTable& table;
  const Pose& pose;
  LargePageVector<Tile> tiles;
  /// The extent of a ring's points along the axes of its frame, in `unit`.
  struct Extent {
    float low[3], high[3];
  };
  /// How flat a ring is.
  struct RingHull {
    Eigen::Matrix3d frame;        ///< an axis in each row
    std::vector<Extent> extents;  ///< after each step to flatSteps()
  };
  /// Made when a search first comes near the ring; integrals do without.
  const RingHull& ringHull(int ring) const {
    return hulls_[static_cast<std::size_t>(ring)].get([&] { return makeHull(ring); });
  }

  std::vector<float> radii;              // kMostSteps + 1 for each ring, in `unit`
  std::vector<std::size_t> first_level;  // for each ring
  LargePageVector<Padded> levels;        // relative to the rings' limits
  /// Known for some kinds of cores.
  std::map<CoreKind, CoreNormal> core_normals;
  Box cage_box;
  double diagonal = 0;  ///< of the cage_box; 0 without faces
  double unit = 1;      ///< the patches' own, as in PatchUnit
  double scale = 1;     ///< SurfacePatches::scale(); what is kept here is in the pose's unit

 private:
  /// Radii are rounded to float: this makes them upper bounds again.
  static constexpr double kFloatMargin = 1e-6;
  /// Rings with few faces keep their points for so many steps; later ones are rarely asked for, and
  /// cost little at their valence.
  static constexpr int kFewSteps = 12;
  /// The extents of all rings are kept for so many steps at least. A smooth ring is flatter than
  /// its size by this many halvings then: 2^-48 of a diagonal is less than what searches leave.
  static constexpr int kFlatSteps = 24;
  /// A ring takes much longer than an evaluation, so that a task has fewer of them than
  /// kRowsPerTask.
  static constexpr std::size_t kRingsPerTask = 16;

  void addTiles(const TileRef& ref, const FaceRectangle& on);
  /// Two directions in the plane that the ring's points approach, or one of several such planes.
  std::pair<Vector3, Vector3> planeOf(int ring) const;
  /// Axes along which the ring's points after many steps are as flat as can be.
  Eigen::Matrix3d frameOf(int ring) const;
  std::unique_ptr<RingHull> makeHull(int ring) const;
  Extent extentOf(const Padded* points, std::size_t count, const Eigen::Matrix3d& frame) const;
  void setRingLevels(int ring);
  void stripPatch(const BSplineTile& tile, int strip, BezierPatch& out) const;

  std::unique_ptr<FirstMade<RingHull>[]> hulls_;
  /// ringShrinkage() of rings with few faces, for the steps of which no points are kept.
  std::map<const Eigenbasis*, std::vector<double>> shrinkages_;
};

}  // namespace limitsurf
