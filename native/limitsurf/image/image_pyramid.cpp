// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/image_pyramid.h"

#include <algorithm>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The pixels of a line that one pixel of the halved line covers, at most three, with their
/// weights.
struct Share {
  int first = 0, count = 0;
  float parts[3];
};

/// The shares of all pixels of a halved line, computed exactly in integers: in units of
/// 1 / (length * half) a pixel of the line is `half` long, and one of the halved line `length`.
std::vector<Share> shares(int length, int half) {
  std::vector<Share> result(static_cast<std::size_t>(half));
  const auto n = static_cast<std::int64_t>(length), m = static_cast<std::int64_t>(half);
  for (std::int64_t j = 0; j < m; ++j) {
    Share& share = result[static_cast<std::size_t>(j)];
    const std::int64_t begin = j * n, end = begin + n;
    share.first = static_cast<int>(begin / m);
    for (std::int64_t i = share.first; i * m < end; ++i) {
      const std::int64_t overlap = std::min(end, (i + 1) * m) - std::max(begin, i * m);
      share.parts[share.count++] = static_cast<float>(overlap) / static_cast<float>(n);
    }
  }
  return result;
}

PixelGrid halved(const PixelGrid& image, int threads) {
  PixelGrid half((image.width + 1) / 2, (image.height + 1) / 2, image.channels);
  const std::vector<Share> columns = shares(image.width, half.width),
                           rows = shares(image.height, half.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  constexpr std::size_t kValuesPerTask = std::size_t{1} << 14;
  const std::size_t grain = std::max<std::size_t>(1, kValuesPerTask / image.rowLength());
  parallelFor(static_cast<std::size_t>(half.height), grain, threads,
              [&](std::size_t begin, std::size_t end) {
                std::vector<float> line(image.rowLength());
                for (std::size_t y = begin; y < end; ++y) {
                  const Share& share = rows[y];
                  for (std::size_t i = 0; i < line.size(); ++i) {
                    float sum = 0;
                    for (int k = 0; k < share.count; ++k) {
                      sum += share.parts[k] * image.row(share.first + k)[i];
                    }
                    line[i] = sum;
                  }
                  float* to = half.row(static_cast<int>(y));
                  for (const Share& column : columns) {
                    const float* from =
                        line.data() + channels * static_cast<std::size_t>(column.first);
                    for (std::size_t c = 0; c < channels; ++c) {
                      float sum = 0;
                      for (int k = 0; k < column.count; ++k) {
                        sum += column.parts[k] * from[channels * static_cast<std::size_t>(k) + c];
                      }
                      *to++ = sum;
                    }
                  }
                }
              });
  return half;
}

}  // namespace

ImagePyramid::ImagePyramid(PixelGrid image, int threads) {
  levels_.push_back(std::move(image));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    PixelGrid half = halved(levels_.back(), threads);
    levels_.push_back(std::move(half));
  }
}

}  // namespace limitsurf
