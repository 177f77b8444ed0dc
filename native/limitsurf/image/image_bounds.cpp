// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "limitsurf/image/filtered_image.h"
#include "limitsurf/image/pixel_extremes.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kBoxesPerTask = 1024;

/// Coordinates of more pixels than this are not told apart: the whole image is taken.
constexpr double kFar = 64;

constexpr float kLargest = std::numeric_limits<float>::max();
/// That of denormal numbers, some of their steps.
constexpr float kLeastRounding = 16 * std::numeric_limits<float>::denorm_min();

/// The pixels along one side of an image between which a range of coordinates is interpolated: one
/// or two ranges of pixels, and perhaps what lies outside of the image.
struct PixelRanges {
  struct Range {
    int first, last;
  };
  Range ranges[2];
  int count = 0;
  bool outside = false;

  PixelRanges(double low, double high, int size, Extension extension) {
    if (!(low > -kFar && high < kFar)) {
      add(0, size - 1);
      outside = extension == Extension::clip;
      return;
    }
    // sample() computes these two pixels in the same way, and rounding is monotone.
    const auto first = static_cast<std::int64_t>(std::floor(low * size - 0.5)),
               last = static_cast<std::int64_t>(std::floor(high * size - 0.5)) + 1;
    switch (extension) {
      case Extension::clip:
        outside = first < 0 || last >= size;
        addInside(std::max<std::int64_t>(first, 0), std::min<std::int64_t>(last, size - 1));
        break;
      case Extension::extend:
        addInside(std::clamp<std::int64_t>(first, 0, size - 1),
                  std::clamp<std::int64_t>(last, 0, size - 1));
        break;
      case Extension::repeat:
        addRepeated(first, last, size, false);
        break;
      default:
        addRepeated(first, last, size, true);
    }
  }

 private:
  void add(int first, int last) { ranges[count++] = {first, last}; }
  void addInside(std::int64_t first, std::int64_t last) {
    if (first <= last) {
      add(static_cast<int>(first), static_cast<int>(last));
    }
  }

  /// Adds the pixels of the image that stand for a range which may lie in several repetitions.
  void addRepeated(std::int64_t first, std::int64_t last, int size, bool mirrored) {
    const std::int64_t repetition = floorOf(first, size), end = floorOf(last, size);
    if (end > repetition + 1) {
      add(0, size - 1);
      return;
    }
    for (std::int64_t i = repetition; i <= end; ++i) {
      const std::int64_t begin = i * size;
      const int a = static_cast<int>(std::max(first, begin) - begin),
                b = static_cast<int>(std::min(last, begin + size - 1) - begin);
      if (mirrored && i % 2 != 0) {
        add(size - 1 - b, size - 1 - a);
      } else {
        add(a, b);
      }
    }
  }
  static std::int64_t floorOf(std::int64_t i, std::int64_t size) {
    return i >= 0 ? i / size : -((-i + size - 1) / size);
  }
};

void checkBoxes(const ImageBoxes& boxes) {
  for (Eigen::Index i = 0; i < boxes.rows(); ++i) {
    const auto box = boxes.row(i);
    if (box.hasNaN()) {
      continue;
    }
    if (!box.allFinite() || box[0] > box[2] || box[1] > box[3]) {
      std::ostringstream message;
      message << "row " << i << ": boxes is from (" << numberText(box[0]) << ", "
              << numberText(box[1]) << ") to (" << numberText(box[2]) << ", " << numberText(box[3])
              << "); its corners must be finite, and the lower one must not be above the upper one";
      throw std::invalid_argument(message.str());
    }
  }
}

}  // namespace

ColourBounds FilteredImage::bounds(const ImageBoxes& boxes, int threads) const {
  checkThreads(threads);
  if (channels() == 4) {
    throw std::invalid_argument(
        "the image has 4 channels, so that colours depend on alpha; bounds are known for images "
        "of 1 to 3 channels");
  }
  checkBoxes(boxes);
  const PixelExtremes extremes(pyramid_.level(0), threads);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ColourBounds result;
  result.low.setConstant(boxes.rows(), channels(), kInfinity);
  result.high.setConstant(boxes.rows(), channels(), -kInfinity);
  parallelFor(static_cast<std::size_t>(boxes.rows()), kBoxesPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  const auto row = static_cast<Eigen::Index>(i);
                  auto low = result.low.row(row), high = result.high.row(row);
                  if (boxes.row(row).hasNaN()) {
                    low.setConstant(std::numeric_limits<float>::quiet_NaN());
                    high = low;
                    continue;
                  }
                  const PixelRanges columns(boxes(row, 0), boxes(row, 2), width(), extension_),
                      rows(boxes(row, 1), boxes(row, 3), height(), extension_);
                  for (int y = 0; y < rows.count; ++y) {
                    for (int x = 0; x < columns.count; ++x) {
                      extremes.include(columns.ranges[x].first, rows.ranges[y].first,
                                       columns.ranges[x].last, rows.ranges[y].last, low.data(),
                                       high.data());
                    }
                  }
                  if (columns.outside || rows.outside) {
                    low = low.cwiseMin(0.f);
                    high = high.cwiseMax(0.f);
                  }
                  for (Eigen::Index c = 0; c < low.size(); ++c) {
                    const float largest = std::max(std::abs(low[c]), std::abs(high[c]));
                    if (largest > 0) {
                      const float rounding = std::max(kRounding * largest, kLeastRounding);
                      const auto inUnit = [&](float value) {
                        return static_cast<float>(units_.colour * value);
                      };
                      low[c] = std::max(inUnit(low[c] - rounding), -kLargest);
                      high[c] = std::min(inUnit(high[c] + rounding), kLargest);
                    }
                  }
                }
              });
  return result;
}

}  // namespace limitsurf
