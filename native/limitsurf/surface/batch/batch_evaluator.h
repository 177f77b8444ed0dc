// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "limitsurf/surface/batch/patch_kernels.h"
#include "limitsurf/surface/batch/patch_runs.h"
#include "limitsurf/surface/batch/row_order.h"
#include "limitsurf/surface/batch/row_parts.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Evaluates many locations. Those that follow each other on one face and lie on the same bicubic
/// patch are evaluated together; what that gives is the same to the bit as TileEvaluator's results
/// one by one. Each thread needs an evaluator of its own.
template <typename Real>
class BatchEvaluator {
 public:
  /// `results` has room for all rows. Derivatives up to `order` are written, and normals if there
  /// is an array for them.
  BatchEvaluator(const TileTable& table, const Pose& pose, int order,
                 const PatchResults<Real>& results);

  /// The rows at places `begin` to `end` - 1 of an order. Each location is read once and checked:
  /// throws LocationError, after some rows may have been written, if it is not on the surface. That
  /// holds for a batch that has been checked before as well, because an array of another program
  /// may be changed by another of its threads.
  void evaluate(const LocationBatch& at, const RowOrder& order, std::size_t begin, std::size_t end);

 private:
  /// At most so many rows are read and put in order at a time.
  static constexpr unsigned kMostRows = 2048;

  /// The tile of a face, of kind kNone if there is no such face.
  TileRef tileOf(std::int64_t face) const;
  /// Rows on the faces given, one for each.
  void evaluateFaces(const std::int64_t faces[], const TileRows& rows);
  /// A row that follows none of its face. It may wait until there are more of them.
  void evaluateSingle(TileRef tile, const TileRows& row);
  /// Those that wait.
  void evaluateSingles();
  /// The rows of a part of a face, on which the tile lies, split as often as `depth`.
  void evaluateTile(TileRef tile, int turns, int depth, const TileRows& rows);
  void evaluateSplit(TileRef tile, int turns, int depth, const TileRows& rows);
  void evaluateRingTile(TileRef tile, int turns, int depth, const TileRows& rows);
  /// Rows whose parameters are in the ring tile's frame, patch by patch.
  void evaluateQuarters(TileRef tile, int turns, int depth, const TileRows& rows);
  /// The same for the first quarters, of which each has many rows; returns the other rows.
  TileRows evaluateFirstQuarters(TileRef tile, int turns, int depth, TileRows rows);
  /// Such rows on the grids after up to so many steps. Those below get results without meaning.
  void evaluateOnGrids(TileRef tile, int steps, int turns, int depth, const TileRows& rows);
  /// The parameters are in the tile's frame. They are `scale` times as large in that of the patch.
  void evaluatePatch(const TilePatch& patch, double scale, const TileRows& rows);
  /// Computes the normals that the kernels have left out.
  void completeNormals(TileRef tile, int turns, int depth, const TileRows& rows);
  /// A row on its own: by a patch where there is one, otherwise by TileEvaluator.
  void evaluateOne(TileLocation place, std::size_t row);
  void evaluateAlone(const TileLocation& place, std::size_t row);
  void putNormal(const TileLocation& place, const Jet& jet, std::size_t row);

  /// The sorted rows of a tile of that depth.
  RowParts& partsAt(int depth);

  const TileTable& table_;
  const Pose& pose_;
  const PatchKernelsOf<Real>& kernels_;
  const int order_;
  const PatchResults<Real> results_;
  PatchRuns runs_;
  TileEvaluator alone_;

  /// Rows that are alone on their faces, which are evaluated together.
  struct Singles {
    static constexpr unsigned kMost = 64;
    unsigned count = 0;
    TileRef tiles[kMost];
    const int* indices[kMost];
    double u[kMost + PatchRun::kReadBeyond] = {}, v[kMost + PatchRun::kReadBeyond] = {};
    std::size_t rows[kMost];
  };
  Singles singles_;
  std::deque<RowParts> parts_;               // by depth; their addresses stay
  RowParts quarters_[Pose::kMostGridSteps];  // by step
};

extern template class BatchEvaluator<double>;
extern template class BatchEvaluator<float>;

}  // namespace limitsurf
