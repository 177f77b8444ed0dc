// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/blue_noise/cell_splitting.h"

namespace limitsurf {

/// Makes trials in cells: each is a random point of its cell, which becomes a candidate if it is in
/// conflict with no accepted point. A cell whose trial failed is discarded if the disc of one
/// accepted point covers it wholly; otherwise it is split, until its parts are too small to matter.
class CellTrials {
 public:
  struct Candidate {
    Location at;
    TrialCell cell;
  };
  /// What the trials of some cells led to.
  struct Outcome {
    std::vector<NoiseDisc> discs;  ///< of the candidates
    std::vector<Candidate> candidates;
    std::vector<TrialCell> parts;  ///< of cells that were split

    void clear() {
      discs.clear();
      candidates.clear();
      parts.clear();
    }
  };

  /// The key of random numbers must be another one in each round.
  CellTrials(NoiseSurface& surface, const DiscGrid& accepted, std::uint64_t key)
      : surface_(surface), splitting_(surface, accepted), key_(key) {}

  /// Makes one trial in each of these cells.
  void make(Span<TrialCell> cells, Outcome& out);

 private:
  /// The cells of one patch, at most PlaceBlock::kCount of them.
  void makeInPatch(Span<TrialCell> cells, Outcome& out);
  void makeInCore(const TrialCell& core, Outcome& out);
  /// Sets a disc's position and normal, and its location, to a place at (s, t) of a core. Returns
  /// |ds x dt| of the core's own parameters there, or 0 if it vanishes.
  double findInCore(const SurfacePiece& core, double s, double t, NoiseDisc& disc,
                    Location& at) const;
  /// Sets a disc's radius. Returns false where there shall be no points.
  template <typename At>
  bool findRadius(const At& at, NoiseDisc& disc) const;
  /// Whether a disc is in conflict with none that was accepted, of those that the last search has
  /// found.
  bool isCandidate(NoiseDisc& disc);
  /// Adds a candidate. `area` is |ds x dt| of the cell's own parameters.
  void add(NoiseDisc& disc, double area, std::uint64_t bits, const Candidate& candidate,
           Outcome& out);

  NoiseSurface& surface_;
  CellSplitting splitting_;
  std::uint64_t key_;
  InterruptionStride stride_;
};

}  // namespace limitsurf
