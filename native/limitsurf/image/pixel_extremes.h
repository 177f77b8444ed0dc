// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/image/image_pyramid.h"

namespace limitsurf {

/// The least and the largest pixels of rectangles of an image, channel by channel.
///
/// Memory: two thirds of the image's.
class PixelExtremes {
 public:
  /// Refers to the image. Cost: O(pixels).
  explicit PixelExtremes(const PixelGrid& image, int threads = 0);

  /// Lowers `low` and raises `high`, of as many numbers as there are channels, to the extremes of
  /// the pixels from (x0, y0) to (x1, y1), which lie in the image. Wide rectangles may be taken to
  /// be longer on each side by up to an eighth of their length. Cost: O(1).
  void include(int x0, int y0, int x1, int y1, float* low, float* high) const;

 private:
  /// Of blocks of 2 x 2 pixels, then of 2 x 2 of these blocks, and so on; blocks at the upper and
  /// the right border may be smaller.
  struct Level {
    PixelGrid low, high;
  };

  const PixelGrid& image_;
  std::vector<Level> levels_;
};

}  // namespace limitsurf
