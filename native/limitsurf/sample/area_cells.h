// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/density_field.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// A part of the surface whose area is bounded: a dyadic rectangle of a patch, or a core.
struct AreaCell {
  SurfacePiece piece;
  std::uint16_t column = 0, row = 0;  ///< of 2^level each
  std::uint8_t level = 0;
  /// On a patch: |ds x dt| with respect to the cell's own (s, t) in [0, 1]^2 is below it. Of a core
  /// the sum over its patches, by CoreTail.
  float bound = 0;
  float area = 0;   ///< estimated
  float outer = 0;  ///< of a core, for CoreTail
};

/// The surface cut so that the area of each part is close to its bound, in face order.
std::vector<AreaCell> areaCells(const SurfacePatches& patches, int threads);

/// The place of a cell on its face.
FaceRectangle rectangleOf(const SurfacePatches& patches, const AreaCell& cell);

/// Picks cells with a probability proportional to their weights.
class CellTable {
 public:
  /// Each cell weighs its bound times the largest density on it.
  CellTable(const SurfacePatches& patches, const std::vector<AreaCell>& cells,
            const DensityField& density, int threads);

  double total() const { return sums_.empty() ? 0 : sums_.back(); }

  struct Choice {
    std::size_t cell;
    double rest;  ///< in [0, 1): where between the cell's ends the number fell
  };
  /// `random` in [0, 1).
  Choice pick(double random) const;
  /// The largest density on a cell.
  double largest(std::size_t cell) const { return largest_.empty() ? 1 : largest_[cell]; }

 private:
  std::vector<double> sums_;  // of the weights of a cell and those before it
  std::vector<float> largest_;
  std::vector<std::uint32_t>
      first_;  // by tenths of the total, so to speak, of which there are many
};

}  // namespace limitsurf
