// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/density.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A density on the whole surface, relative to its largest value, of which bounds are known: it is
/// bilinear between the points of a regular grid on each Ptex face. A constant density is 1
/// everywhere.
class DensityField {
 public:
  DensityField() = default;
  /// A density that is given at vertices, exactly. Throws std::invalid_argument if it is 0
  /// everywhere.
  explicit DensityField(const Density& density);
  /// A density function, read on a grid of 2^levels[face] squares a side; faces with level -1 are
  /// not read, nor are points where the limit is 0.
  DensityField(const Density& density, const std::vector<int>& levels);

  bool isConstant() const { return first_.empty(); }
  /// Whether a function was 0 wherever it was read.
  bool isZero() const { return !(largest_ > 0); }
  /// The number of points of the grids.
  std::size_t pointCount() const { return values_.size(); }
  /// The largest weight, by which all have been divided.
  double largest() const { return largest_; }

  /// The density at a location, in [0, 1].
  double at(const Location& location) const;
  /// The largest density on a rectangle.
  double largestOn(const FaceRectangle& rectangle) const;
  /// The mean density on a rectangle, over its parameters.
  double meanOn(const FaceRectangle& rectangle) const;

 private:
  const double* grid(int face) const { return values_.data() + first_[face]; }
  void normalise();

  double largest_ = 1;
  std::vector<int> levels_;
  std::vector<std::size_t> first_;
  std::vector<double> values_;  // face by face, row by row: (2^level + 1)^2 for each face
};

}  // namespace limitsurf
