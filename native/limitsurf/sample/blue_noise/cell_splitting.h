// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "limitsurf/interruption_point.h"
#include "limitsurf/sample/blue_noise/bounded_patch.h"
#include "limitsurf/sample/blue_noise/core_descent.h"
#include "limitsurf/sample/blue_noise/disc_finder.h"
#include "limitsurf/sample/blue_noise/noise_radii.h"
#include "limitsurf/sample/blue_noise/trial_cell.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// The surface that is cut into cells, and the radii of discs on it.
struct NoiseSurface {
  const SurfacePatches& patches;
  const SettlingCores& settling;
  NoiseRadii radii;
  double gap;               ///< cells smaller than so many radii are discarded
  double most_first_cells;  ///< more of them are refused
  std::atomic<std::size_t> first_cells{0};
  /// Of the one cell of each tile that is a core, once it is needed. Only what tries this cell
  /// writes to it.
  std::vector<CoreExtent> cores;
};

/// Splits cells, and tells which of them discs cover. It keeps the patch of the last cell, because
/// cells come sorted by patch.
class CellSplitting {
 public:
  CellSplitting(NoiseSurface& surface, const DiscGrid& accepted)
      : surface_(surface), accepted_(accepted) {}

  /// The search that tells which discs may cover a cell: the last one counts.
  DiscFinder& accepted() { return accepted_; }
  /// The patch of a cell that is no core.
  const BoundedPatch& patchOf(const TrialCell& cell);
  /// Whether a core has no room for points. If not, computes the smallest radius in it.
  bool isEmptyCore(const TrialCell& core, double& smallest) const;

  /// Appends the first cells of a piece.
  void begin(const SurfacePiece& piece, std::vector<TrialCell>& cells);
  /// Appends the parts of a cell that is no core, but for those that a disc covers; none if one
  /// covers the whole cell, or if the parts were too small to matter.
  void split(const TrialCell& cell, const BoundedPatch& patch, const CellExtent& extent,
             double smallest, std::vector<TrialCell>& parts);
  /// The same of a core.
  void splitCore(const TrialCell& core, double smallest, std::vector<TrialCell>& parts);

  /// A cell in which a point has been accepted, and whether the point's disc covers it wholly.
  struct Hit {
    const NoiseDisc* disc;
    const TrialCell* cell;
    bool is_covered;
  };
  /// Sets is_covered.
  void findCovered(std::vector<Hit>& hits);

 private:
  /// Appends the first cells of some cells of a patch, at most ExtentBlock::kCount.
  void begin(Span<TrialCell> whole, const BoundedPatch& patch, std::vector<TrialCell>& cells);
  /// Whether discs that see the one or the other side of a fold leave out no more of a cell than a
  /// strip that is too narrow to matter. They are those that the last search has found.
  bool isCoveredTogether(const TrialCell& cell, const BoundedPatch& patch, const CellExtent& extent,
                         double smallest) const;
  bool coversCore(const NoiseDisc& disc, const TrialCell& core);
  void beginCore(const TrialCell& core, std::vector<TrialCell>& cells);
  /// Appends the first cells of a split core: those of its patches, and those of the smaller core.
  void beginSplit(const SurfacePatches::SplitCore& split, double smallest,
                  std::vector<TrialCell>& cells);
  bool coversCore(const NoiseDisc& disc, const TrialCell& core, double smallest);
  CoreDescent& descentOf(const TrialCell& core, double smallest);
  const CoreExtent& coreExtentOf(const TrialCell& core, double smallest);

  NoiseSurface& surface_;
  DiscFinder accepted_;
  SurfacePiece piece_;
  std::optional<BoundedPatch> patch_;
  std::optional<CoreDescent> descent_;  // of the present core, once it is needed
  InterruptionStride stride_;
};

}  // namespace limitsurf
