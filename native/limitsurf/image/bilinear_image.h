// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Pixels that another object owns, interpolated as graphics hardware does: `channels` numbers
/// each, row after row from the image's lower left corner, the centre of pixel (x, y) at
/// ((x + 1/2) / width, (y + 1/2) / height).
struct BilinearImage {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

  const float* pixels;
  int width, height, channels;

  /// The values at the places (s, t), a row for each, in double precision: bilinear between the
  /// centres of four pixels, and beyond the outermost centres the nearest value on their border.
  /// Throws std::invalid_argument naming the first place that is not finite.
  DataRows sample(const Eigen::Ref<const Places>& places, int threads = 0) const;
};

}  // namespace limitsurf
