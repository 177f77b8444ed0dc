// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/filtered_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "limitsurf/image/image_lookup.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPlacesPerTask = 256, kRowsOfPixelsPerTask = 16;

/// Names the first pixel of a row that is not finite; there is one.
[[noreturn]] void refuseRow(const float* row, int y, int channels) {
  int i = 0;
  while (std::isfinite(row[i])) {
    ++i;
  }
  std::ostringstream message;
  message << "pixel (" << i / channels << ", " << y << "): channel " << i % channels << " is "
          << row[i] << "; pixels must be finite";
  throw std::invalid_argument(message.str());
}

void checkSize(int width, int height, int channels) {
  if (width < 1 || height < 1 || channels < 1 || channels > 4) {
    throw std::invalid_argument("an image of " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels of " + std::to_string(channels) +
                                " channels; expected at least 1 x 1 pixels of 1 to 4 channels");
  }
}

float unitOf(float largest) {
  return largest > PixelUnits::kLargestPixel
             ? std::ldexp(1.f, std::ilogb(largest) - std::ilogb(PixelUnits::kLargestPixel))
             : 1.f;
}

/// The largest magnitudes among the numbers of a row, one for each remainder of their indices
/// modulo 4: infinite or NaN where a number is. The bits of magnitudes are in the order of the
/// magnitudes.
std::array<float, 4> largestOf(const float* row, std::size_t length) {
  constexpr std::int32_t kMagnitude = 0x7fffffff;
  std::int32_t most[4] = {};
  const auto include = [&](std::size_t begin, std::size_t count) {
    std::int32_t bits[4] = {};
    std::memcpy(bits, row + begin, sizeof(float) * count);
    for (std::size_t c = 0; c < 4; ++c) {
      most[c] = std::max(most[c], bits[c] & kMagnitude);
    }
  };
  const std::size_t whole = length / 4 * 4;
  for (std::size_t i = 0; i < whole; i += 4) {
    include(i, 4);
  }
  include(whole, length - whole);
  std::array<float, 4> result;
  std::memcpy(result.data(), most, sizeof most);
  return result;
}

/// The units of an image whose size is checked. Throws for pixels that are not finite.
PixelUnits unitsOf(const float* pixels, int width, int height, int channels, int threads) {
  std::vector<std::array<float, 4>> rows(static_cast<std::size_t>(height));
  const std::size_t length = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  parallelFor(rows.size(), kRowsOfPixelsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      rows[y] = largestOf(pixels + length * y, length);
    }
  });
  PixelUnits largest = {0, 0};
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (!std::isfinite(rows[y][c])) {
        refuseRow(pixels + length * y, static_cast<int>(y), channels);
      }
      float& of_kind = channels == 4 && c == 3 ? largest.alpha : largest.colour;
      of_kind = std::max(of_kind, rows[y][c]);
    }
  }
  return {unitOf(largest.colour), unitOf(largest.alpha)};
}

/// A copy of the pixels in the units. With `multiply` their colours are multiplied by alpha, if
/// they have one.
PixelGrid copied(const float* pixels, int width, int height, int channels, bool multiply,
                 const PixelUnits& units, int threads) {
  PixelGrid image(width, height, channels);
  const bool is_scaled = units.colour != 1 || units.alpha != 1;
  const auto copyRow = [&](std::size_t y) {
    const float* from = pixels + image.rowLength() * y;
    float* to = image.row(static_cast<int>(y));
    std::copy(from, from + image.rowLength(), to);
    for (std::size_t i = 0; is_scaled && i < image.rowLength(); ++i) {
      to[i] /= channels == 4 && i % 4 == 3 ? units.alpha : units.colour;
    }
    for (std::size_t i = 0; multiply && channels == 4 && i < image.rowLength(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        to[i + c] *= to[i + 3];
      }
    }
  };
  parallelFor(static_cast<std::size_t>(height), kRowsOfPixelsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) {
                  copyRow(y);
                }
              });
  return image;
}

template <int kChannels>
void sampleRows(const ImagePyramid& pyramid, const PixelUnits& units, Extension extension,
                const ImagePoints& st, const Footprints& footprint, Eigen::Index begin,
                Eigen::Index end, Colours& out) {
  const ImageLookup<kChannels> lookup(pyramid, units, extension);
  for (Eigen::Index i = begin; i < end; ++i) {
    if (st.row(i).hasNaN()) {
      out.row(i).setZero();
    } else {
      lookup.sample(st.row(i).data(), footprint.row(i).data(), out.row(i).data());
    }
  }
  auto rows = out.middleRows(begin, end - begin);
  if (!rows.allFinite()) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    rows = rows.cwiseMax(-kLargest).cwiseMin(kLargest);
  }
}

}  // namespace

void checkSamples(Eigen::Ref<const ImagePoints> st, Eigen::Ref<const Footprints> footprint) {
  if (st.rows() != footprint.rows()) {
    throw std::invalid_argument("st has " + std::to_string(st.rows()) + " rows and footprint " +
                                std::to_string(footprint.rows()));
  }
  for (Eigen::Index i = 0; i < st.rows(); ++i) {
    if (st.row(i).hasNaN()) {
      continue;
    }
    if (!st.row(i).allFinite() || !footprint.row(i).allFinite()) {
      std::ostringstream message;
      message << "row " << i << ": st (" << st.row(i) << ") with footprint (" << footprint.row(i)
              << ") is not finite";
      throw std::invalid_argument(message.str());
    }
  }
}

FilteredImage::FilteredImage(const float* pixels, int width, int height, int channels,
                             Extension extension, bool premultiplied, int threads)
    : units_((checkThreads(threads), checkSize(width, height, channels),
              unitsOf(pixels, width, height, channels, threads))),
      pyramid_(copied(pixels, width, height, channels, !premultiplied, units_, threads), threads),
      extension_(extension) {
  if (premultiplied) {
    units_.colour /= units_.alpha;
  }
}

Colours FilteredImage::sample(const ImagePoints& st, const Footprints& footprint,
                              int threads) const {
  checkThreads(threads);
  checkSamples(st, footprint);
  Colours out(st.rows(), channels());
  const auto rows = [&](auto channel_count) {
    parallelFor(static_cast<std::size_t>(st.rows()), kPlacesPerTask, threads,
                [&](std::size_t begin, std::size_t end) {
                  sampleRows<channel_count()>(pyramid_, units_, extension_, st, footprint,
                                              static_cast<Eigen::Index>(begin),
                                              static_cast<Eigen::Index>(end), out);
                });
  };
  switch (channels()) {
    case 1:
      rows(std::integral_constant<int, 1>());
      break;
    case 2:
      rows(std::integral_constant<int, 2>());
      break;
    case 3:
      rows(std::integral_constant<int, 3>());
      break;
    default:
      rows(std::integral_constant<int, 4>());
  }
  return out;
}

}  // namespace limitsurf
