// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// The layout of an image that holds a square tile for each Ptex face, so that no UV map is needed.
///
/// A tile has (resolution + 1) x (resolution + 1) pixels; pixel (i, j) holds the value at
/// (u, v) = (i, j) / resolution. The values along the sides of a face therefore stand in the tiles
/// of all faces that meet there. Bilinear interpolation within a tile needs no neighbouring tile,
/// and it is continuous across faces wherever the values are, with one exception. Where two
/// sub-faces of an n-gon meet the side of a quad, they have twice as many pixels along it: there
/// the interpolated values agree at the pixels of the quad, and differ between them.
///
/// Tiles stand in rows of columns() tiles from the lower left corner of the image, face after face:
/// the tile of face f begins at the pixel (f mod columns, f div columns) * (resolution + 1). The
/// pixels that remain in the last row belong to no face.
class PtexLayout {
 public:
  /// Throws std::invalid_argument for fewer than one face, for a resolution that is not a power of
  /// two or exceeds kMostResolution, and if the image would have more than kMostSide pixels along a
  /// side.
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
  /// The first pixel of a face's tile.
  Pixel origin(int face) const;
  /// All pixels of all tiles, face after face and row after row, and the location of each.
  std::vector<Pixel> pixels() const;
  std::vector<Location> locations() const;

  /// The image coordinates of locations, a row for each: (0, 0) is the lower left corner of the
  /// image, (1, 1) the upper right one. Bilinear interpolation there reads pixels of the face's own
  /// tile alone. Throws LocationError naming the first row whose face is not one of the layout's.
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> mapCoordinates(Span<Location> at) const;

 private:
  int faces_, resolution_, columns_;
};

}  // namespace limitsurf
