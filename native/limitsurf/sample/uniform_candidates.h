// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/random_bits.h"
#include "limitsurf/sample/area_cells.h"
#include "limitsurf/sample/cell_table.h"
#include "limitsurf/sample/density_field.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// Independent random locations, by rejection. Their density is proportional to area times a
/// density field. If the field is constant it is proportional to area times the largest density on
/// each cell, as the table has it. Each sample has an endless sequence of candidates of its own,
/// most of which are accepted.
class UniformCandidates {
 public:
  UniformCandidates(const SurfacePatches& patches, const std::vector<AreaCell>& cells,
                    const CellTable& table, const DensityField& density, std::uint64_t seed)
      : patches_(patches), cells_(cells), table_(table), density_(density), key_(keyOf(seed)) {}

  struct Candidate {
    Location at;
    double largest = 1;  ///< density on its cell, as the table has it
  };
  /// The next candidate of a sample that is accepted. `attempt` counts the candidates tried.
  Candidate next(std::size_t sample, std::uint32_t& attempt) const;
  /// The first accepted candidates of `count` samples, beginning with number `first`. They are
  /// looked for in the order of the surface's cells, since most of the time it takes to find one
  /// alone is spent waiting for memory.
  void findFirst(std::size_t first, std::size_t count, Location* out, int threads) const;

  /// One more random number for the candidate that next() returned last.
  double number(std::size_t sample, std::uint32_t attempt) const {
    return uniformIn01(mixed(streamOf(sample) + kNumbers * (attempt - 1) + kNumbers - 1));
  }

 private:
  /// The number of random numbers that a candidate may use.
  static constexpr std::uint64_t kNumbers = 5;

  /// A patch that is kept, because the next candidate is often on it as well.
  struct KeptPatch {
    SurfacePiece piece;
    BezierPatch patch;
  };
  /// A sample whose candidates have all been rejected so far.
  struct Open {
    std::uint32_t sample, attempt;  // the number of its next candidate
  };

  std::uint64_t streamOf(std::size_t sample) const { return mixed(key_ ^ mixed(sample)); }
  bool accept(std::uint64_t stream, KeptPatch& kept, Candidate& out) const;
  /// Picks a patch of a core, and the bound of |ds x dt| on it. Returns false where rounding leads
  /// beyond the last patch: the candidate is rejected then.
  bool pickFromCore(const AreaCell& cell, double number, SurfacePiece& piece, double& bound) const;
  /// Sorts samples by the cells of their next candidates, roughly.
  std::vector<Open> sorted(const std::vector<Open>& open, std::size_t first, int threads) const;

  const SurfacePatches& patches_;
  const std::vector<AreaCell>& cells_;
  const CellTable& table_;
  const DensityField& density_;
  std::uint64_t key_;
};

}  // namespace limitsurf
