// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// An image that holds a square tile for each Ptex face, so that no UV map is needed.
///
/// A tile has (resolution + 1) x (resolution + 1) pixels: pixel (i, j) holds the value at
/// (u, v) = (i, j) / resolution. So the values along a face's sides stand in the tiles of all faces
/// that meet there, and what is interpolated bilinearly within a tile, which needs no neighbour,
/// is continuous across faces wherever the values are.
///
/// Tiles follow each other in rows of columns() tiles from the lower left corner of the image, face
/// after face: that of face f begins at the pixel (f mod columns, f div columns) * (resolution +
/// 1). Pixels of an unfinished last row belong to no face.
class PtexLayout {
 public:
  /// Throws std::invalid_argument for no faces, a resolution that is no power of two or is above
  /// kMostResolution, and where the image would have more than kMostSide pixels along a side.
  PtexLayout(int faces, int resolution);

  static constexpr int kMostResolution = 4096;
  static constexpr int kMostSide = 65536;

  int faces() const { return faces_; }
  int resolution() const { return resolution_; }
  int columns() const { return columns_; }  ///< the smallest number that makes no column too high
  int width() const { return columns_ * (resolution_ + 1); }
  int height() const { return (faces_ + columns_ - 1) / columns_ * (resolution_ + 1); }

  /// A pixel that belongs to a face, counted from the lower left corner of the image.
  struct Pixel {
    int x, y;
  };
  /// A tile's first pixel.
  Pixel origin(int face) const;
  /// All pixels of all tiles, face after face, row after row; and what place each stands for.
  std::vector<Pixel> pixels() const;
  std::vector<Location> locations() const;

  /// Where on the image a location's value is found, from (0, 0) at its lower left corner to (1,
  /// 1): bilinear filtering there reads pixels of the face's own tile alone. One row per location,
  /// whose face must be one of the layout's.
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> mapCoordinates(Span<Location> at) const;

 private:
  int faces_, resolution_, columns_;
};

}  // namespace limitsurf
