// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "limitsurf/kept.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/surface/batch/patch_run.h"
#include "limitsurf/surface/fixed/fixed_rows.h"
#include "limitsurf/surface/pose/padded_points.h"
#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tiled_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Locations that stay, in rows, with all that is known of them before any frame.
class FixedPlan {
 public:
  /// As FixedRows has them. Throws std::invalid_argument for 2^32 locations or more.
  FixedPlan(std::shared_ptr<const TiledSurface> tiles, std::size_t count,
            const std::function<TileLocation(std::size_t)>& place, int order, int threads);
  ~FixedPlan();

  int vertexCount() const { return tiles_->table.points.cagePoints(); }
  std::size_t rowCount() const { return row_count_; }
  int order() const { return order_; }
  std::size_t bytes() const;

 private:
  friend class FixedFrame;
  struct Working;

  std::shared_ptr<const TiledSurface> tiles_;
  std::size_t row_count_;
  int order_;
  FixedRows rows_;
  PosePart part_;  // what rows_.posed need
  Kept<Working> kept_;
};

/// The rows of a plan with the control points of one frame.
class FixedFrame {
 public:
  /// A plan's rows from `begin` to `end` begin and end with multiples of this, or at its end.
  static constexpr std::size_t kRowsPerBlock = FixedRows::kRowsPerBlock;

  /// The control points must have been checked. The plan must live on.
  FixedFrame(const FixedPlan& plan, const RowsIn<Points>& control_points, int threads);
  ~FixedFrame();
  FixedFrame(const FixedFrame&) = delete;
  FixedFrame& operator=(const FixedFrame&) = delete;

  const PointsSize& size() const;
  /// Writes the rows of the plan from `begin` to `end`; that of `first` to the beginning of the
  /// results.
  template <typename Real>
  void evaluate(std::size_t begin, std::size_t end, std::size_t first,
                const PatchResults<Real>& results) const;

 private:
  const FixedPlan& plan_;
  std::unique_ptr<FixedPlan::Working> working_;
};

}  // namespace limitsurf
