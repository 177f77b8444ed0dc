// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "limitsurf/image/filtered_image.h"
#include "limitsurf/image/image_pyramid.h"

namespace limitsurf {

/// A weighted sum of pixels, some of which may lie outside the image.
template <int kChannels>
class PixelSum {
 public:
  PixelSum(const PixelGrid& level, Extension extension) : level_(level), extension_(extension) {}

  void add(int x, int y, float weight) {
    weights_ += weight;
    const int column = inside(x, level_.width), row = inside(y, level_.height);
    if (column >= 0 && row >= 0) {
      addPixel(level_.row(row) + kChannels * column, weight);
    }
  }

  /// Adds the pixels first to last of row y, each with weight(x).
  template <typename Weight>
  void addRow(int y, int first, int last, const Weight& weight) {
    const int row = inside(y, level_.height);
    if (row < 0) {
      for (int x = first; x <= last; ++x) {
        weights_ += weight(x);
      }
      return;
    }
    const float* pixels = level_.row(row);
    if (first >= 0 && last < level_.width) {
      for (int x = first; x <= last; ++x) {
        const float w = weight(x);
        weights_ += w;
        addPixel(pixels + kChannels * x, w);
      }
      return;
    }
    for (int x = first; x <= last; ++x) {
      const float w = weight(x);
      weights_ += w;
      const int column = inside(x, level_.width);
      if (column >= 0) {
        addPixel(pixels + kChannels * column, w);
      }
    }
  }

  /// Adds the weighted mean, times `part`, to `out`.
  void addMean(float part, float* out) const {
    for (int c = 0; c < kChannels; ++c) {
      out[c] += part * sum_[c] / weights_;
    }
  }

 private:
  void addPixel(const float* pixel, float weight) {
    for (int c = 0; c < kChannels; ++c) {
      sum_[c] += weight * pixel[c];
    }
  }

  /// The index, inside the image, of the pixel that stands for index i; -1 if none does.
  int inside(int i, int count) const {
    if (i >= 0 && i < count) {
      return i;
    }
    switch (extension_) {
      case Extension::clip:
        return -1;
      case Extension::extend:
        return std::clamp(i, 0, count - 1);
      case Extension::repeat:
        return modulo(i, count);
      default: {
        const int j = modulo(i, 2 * count);
        return j < count ? j : 2 * count - 1 - j;
      }
    }
  }
  static int modulo(int i, int period) {
    const int rest = i % period;
    return rest < 0 ? rest + period : rest;
  }

  const PixelGrid& level_;
  Extension extension_;
  float sum_[kChannels] = {};
  float weights_ = 0;
};

}  // namespace limitsurf
