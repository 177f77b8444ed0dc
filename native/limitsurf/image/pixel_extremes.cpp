// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/pixel_extremes.h"

#include <algorithm>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A rectangle is looked up on the first level on which it is at most this many blocks wide and
/// high.
constexpr int kMostBlocks = 16;
constexpr std::size_t kRowsPerTask = 16;

/// For each block of 2 x 2 pixels the number that `better` prefers.
template <typename Better>
PixelGrid reduced(const PixelGrid& grid, int threads, const Better& better) {
  PixelGrid half((grid.width + 1) / 2, (grid.height + 1) / 2, grid.channels);
  parallelFor(static_cast<std::size_t>(half.height), kRowsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  const int y = static_cast<int>(i);
                  const float* lower = grid.row(2 * y);
                  const float* upper = grid.row(std::min(2 * y + 1, grid.height - 1));
                  float* to = half.row(y);
                  for (int x = 0; x < half.width; ++x) {
                    const int left = 2 * x * grid.channels,
                              right = std::min(2 * x + 1, grid.width - 1) * grid.channels;
                    for (int c = 0; c < grid.channels; ++c) {
                      *to++ = better(better(lower[left + c], lower[right + c]),
                                     better(upper[left + c], upper[right + c]));
                    }
                  }
                }
              });
  return half;
}

}  // namespace

PixelExtremes::PixelExtremes(const PixelGrid& image, int threads) : image_(image) {
  const auto lower = [](float a, float b) { return std::min(a, b); };
  const auto higher = [](float a, float b) { return std::max(a, b); };
  const PixelGrid* low = &image;
  const PixelGrid* high = &image;
  while (std::max(low->width, low->height) > kMostBlocks) {
    PixelGrid next_low = reduced(*low, threads, lower), next_high = reduced(*high, threads, higher);
    levels_.push_back({std::move(next_low), std::move(next_high)});
    low = &levels_.back().low;
    high = &levels_.back().high;
  }
}

void PixelExtremes::include(int x0, int y0, int x1, int y1, float* low, float* high) const {
  std::size_t level = 0;
  while (level < levels_.size() &&
         std::max((x1 >> level) - (x0 >> level), (y1 >> level) - (y0 >> level)) >= kMostBlocks) {
    ++level;
  }
  const PixelGrid& lows = level == 0 ? image_ : levels_[level - 1].low;
  const PixelGrid& highs = level == 0 ? image_ : levels_[level - 1].high;
  const int channels = image_.channels;
  for (int y = y0 >> level; y <= y1 >> level; ++y) {
    for (int x = x0 >> level; x <= x1 >> level; ++x) {
      for (int c = 0; c < channels; ++c) {
        low[c] = std::min(low[c], lows.row(y)[x * channels + c]);
        high[c] = std::max(high[c], highs.row(y)[x * channels + c]);
      }
    }
  }
}

}  // namespace limitsurf
