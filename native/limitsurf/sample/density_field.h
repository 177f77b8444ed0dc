// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/density.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Weights on the whole surface, relative to the largest, that can be bounded: bilinear between the
/// points of a regular grid on each Ptex face. 1 everywhere if made of a constant density.
class DensityField {
 public:
  DensityField() = default;
  /// Of a density that is no function, exactly. Throws std::invalid_argument where all is 0.
  explicit DensityField(const Density& density);
  /// Of a function: 2^levels[face] squares a side, -1 for faces that are not to be asked about.
  DensityField(const Density& density, const std::vector<int>& levels);

  bool isConstant() const { return first_.empty(); }
  /// What all weights have been divided by.
  double largest() const { return largest_; }

  /// In [0, 1].
  double at(const Location& location) const;
  /// The largest on a rectangle.
  double largestOn(const FaceRectangle& rectangle) const;
  /// A mean of the rectangle's corners and middle.
  double meanOn(const FaceRectangle& rectangle) const;

 private:
  const double* grid(int face) const { return values_.data() + first_[face]; }
  void normalise();

  double largest_ = 1;
  std::vector<int> levels_;
  std::vector<std::size_t> first_;
  std::vector<double> values_;  // row by row of each face: (2^level + 1)^2
};

}  // namespace limitsurf
