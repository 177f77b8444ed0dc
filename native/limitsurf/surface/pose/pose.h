// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "limitsurf/eigen/tile_grid.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose/padded_points.h"
#include "limitsurf/surface/pose/steps_made.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The points and rings of a table that some of its tiles need.
struct PosePart {
  std::vector<int> points;  ///< refined points, each after those that it is made of
  std::vector<int> rings;
};

/// Everything in a surface that depends on the positions of its control points.
///
/// Regular tiles read the points themselves. A ring keeps the coefficients of its modes, and a ring
/// tile keeps the control grids of its first subdivision steps, because a random location lies
/// deeper than n steps with a probability of only 4^-n. Grids are made when they are first needed:
/// a pose of which only some locations are evaluated does without most of them.
class Pose {
 public:
  /// The number of steps whose grids are kept in a tile that is a whole Ptex face: 1 location in
  /// 256 lies deeper. Each split of the face takes one away. Fewer are kept, but at least one, if
  /// all grids together would take more memory than kGridBytes.
  static constexpr int kMostGridSteps = 4;
  static constexpr std::size_t kGridBytes = std::size_t{256} << 20;

  /// Control points relative to the ring's limit, which is stored in slot (-1, -1).
  struct Grid {
    Padded points[tile_grid::kSlots];

    const Padded& limit() const { return points[tile_grid::slot(-1, -1)]; }
  };
  /// The caller's memory for grids that another thread is just making: nobody waits for another.
  using OwnGrids = std::vector<Grid>;

  struct RingPose {
    Padded limit;         ///< the limit position of the extraordinary vertex
    Points coefficients;  ///< of the modes, relative to the limit
    double largest = 0;   ///< the largest coordinate of a coefficient but that of the constant mode

    /// The rounding error of `limit`.
    Padded constant() const {
      return {coefficients(0, 0), coefficients(0, 1), coefficients(0, 2), 0};
    }
  };

  /// The outer points of a ring tile, relative to the ring's limit.
  struct OuterPoints {
    Padded points[tile_grid::kOuter];
  };

  /// With `part`, which must live on, the pose is one of these points and rings alone.
  explicit Pose(const TileTable& table, const PosePart* part = nullptr);

  /// If something is thrown meanwhile, isSet() is false until the next time.
  void set(const RowsIn<Points>& cage, int threads);
  bool isSet() const { return is_set_; }

  /// How large the control points are.
  const PointsSize& size() const { return size_; }

  const Padded& point(int i) const { return points_[i]; }
  /// The rounding error of a point, so that point(i) + residual(i) has 24 bits more. It is 0 unless
  /// the table is fine.
  Padded residual(int i) const {
    const int refined = i - table_->points.cagePoints();
    return refined < 0 || residuals_.empty()
               ? Padded(Padded::Zero())
               : Padded(residual_unit_ * widened(residuals_[refined]));
  }
  /// The vector between two points, rounded relative to its own size.
  Padded difference(int to, int from) const {
    return (points_[to] - points_[from]) + (residual(to) - residual(from));
  }
  const RingPose& ring(int i) const { return rings_[i]; }
  OuterPoints outerPoints(int tile) const;
  /// The grids after 1, 2, ... `steps` <= gridSteps() steps. They are valid as long as the pose and
  /// `own`, and until `own` is used again.
  const Grid* grids(int tile, int steps, OwnGrids& own) const {
    return steps_made_.has(tile, steps) ? keptGrids(tile) : madeGrids(tile, steps, own);
  }
  /// The place of the grids, which may not be made yet.
  const Grid* keptGrids(int tile) const { return &grids_[first_grid_[tile]]; }
  int gridSteps(const RingTile& tile) const { return grid_steps_[tile.depth]; }

 private:
  static Padded widened(const std::array<float, 3>& v) { return {v[0], v[1], v[2], 0}; }

  template <bool kFine>
  void refinePoint(int point);
  void refinePoints();
  /// `memory` is working memory that one ring after the other uses.
  void setRing(int ring, std::vector<Padded>& memory);
  /// A ring's points relative to its limit after 0, 1, 2, ... steps, one behind the other.
  Padded* ringLevels(int ring) const { return &ring_levels_[first_level_[ring]]; }
  const Grid* madeGrids(int tile, int steps, OwnGrids& own) const;
  /// Makes the grids from the one after `made` steps on.
  void makeGrids(int tile, int made, int steps, Grid grids[]) const;

  const TileTable* table_;
  const PosePart* part_;
  bool is_set_ = false;
  PointsSize size_;
  int grid_steps_[TileTable::kMostDepth + 1];  // by depth
  std::vector<Padded> points_;
  std::vector<std::array<float, 3>> residuals_;  // of the refined points, over residual_unit_
  double residual_unit_ = 1;  // a power of two of about the size of the coordinates
  std::vector<RingPose> rings_;
  std::vector<int> ring_steps_;  // per ring: the most that one of its tiles needs
  std::vector<std::size_t> first_level_, first_grid_;
  std::unique_ptr<Padded[]> ring_levels_;
  std::unique_ptr<Grid[]> grids_;
  StepsMade steps_made_;
};

}  // namespace limitsurf
