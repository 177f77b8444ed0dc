// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace limitsurf {

/// An image of float32 pixels, row after row, with the channels of a pixel side by side.
struct PixelGrid {
  PixelGrid(int columns, int rows, int channels_of_each)
      : width(columns),
        height(rows),
        channels(channels_of_each),
        values(new float[static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                         static_cast<std::size_t>(channels_of_each)]) {}

  float* row(int y) { return values.get() + rowLength() * static_cast<std::size_t>(y); }
  const float* row(int y) const { return values.get() + rowLength() * static_cast<std::size_t>(y); }
  std::size_t rowLength() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }

  int width, height, channels;
  std::unique_ptr<float[]> values;
};

/// Powers of two by which the numbers of an image are smaller in its pyramid than they were given,
/// so that sums of very large ones stay finite: colours, multiplied by alpha if they have one, and
/// alpha. Both are 1 where none of these is larger than kLargest.
struct PixelUnits {
  /// Sums have weights of at most 2^12 together.
  static constexpr double kLargest = 0x1p112;
  double colour = 1, alpha = 1;
};

/// An image and its repeated halvings, down to one pixel. Sizes are halved and rounded up. A pixel
/// of a halved image is the mean of the larger one over the pixel's area, so that all levels cover
/// the same square and have the same mean for any size.
class ImagePyramid {
 public:
  explicit ImagePyramid(PixelGrid image, int threads = 0);

  int size() const { return static_cast<int>(levels_.size()); }
  const PixelGrid& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<PixelGrid> levels_;
};

}  // namespace limitsurf
