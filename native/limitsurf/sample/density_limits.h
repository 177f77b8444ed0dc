// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// Numbers that a density function does not exceed: one for each of side x side equal squares of
/// every Ptex face. A limit holds for the whole square, its borders included.
class DensityLimits {
 public:
  /// No limits are known.
  DensityLimits() = default;

  /// `values` holds side x side numbers for each face, row by row: u increases within a row. Throws
  /// std::invalid_argument if `side` is no power of two from 1 to kMostSide, or if the number of
  /// values is no multiple of side x side. The values are checked when they are used: they must be
  /// finite and at least 0, except on faces that have no surface.
  DensityLimits(int side, std::vector<double> values);

  static constexpr int kMostSide = 1024;

  bool areKnown() const { return side_ > 0; }
  int side() const { return side_; }
  std::int64_t faceCount() const;

  struct Range {
    double least, largest;
  };
  /// The least and the largest limit of the squares that a rectangle of a face overlaps. Throws
  /// std::invalid_argument naming a limit that is negative or not finite.
  Range on(int face, double u0, double u1, double v0, double v1) const;
  /// The limit at a location: on borders of squares that of the square with the larger one.
  double at(const Location& location) const;

 private:
  double value(int face, int row, int column) const {
    return values_[static_cast<std::size_t>(side_) *
                       (static_cast<std::size_t>(side_) * static_cast<std::size_t>(face) +
                        static_cast<std::size_t>(row)) +
                   static_cast<std::size_t>(column)];
  }

  int side_ = 0;
  std::vector<double> values_;
};

}  // namespace limitsurf
