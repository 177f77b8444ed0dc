// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Pixels that somebody else owns, read as texture units read them: `channels` numbers each, row
/// after row from the image's lower left corner, the centre of pixel (x, y) at
/// ((x + 1/2) / width, (y + 1/2) / height).
struct BilinearImage {
  const float* pixels;
  int width, height, channels;

  /// One row per place (s, t), computed in double precision: between the centres of four pixels
  /// their bilinear interpolation, beyond the outermost centres the nearest value on their border.
  /// Throws std::invalid_argument naming the first place that is not finite.
  DataRows sample(const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& places,
                  int threads = 0) const;
};

}  // namespace limitsurf
