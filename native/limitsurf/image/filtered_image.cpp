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
#include "limitsurf/number_text.h"
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
          << numberText(row[i]) << "; pixels must be finite";
  throw std::invalid_argument(message.str());
}

void checkSize(int width, int height, int channels) {
  if (width < 1 || height < 1 || channels < 1 || channels > 4) {
    throw std::invalid_argument("an image of " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels of " + std::to_string(channels) +
                                " channels; expected at least 1 x 1 pixels of 1 to 4 channels");
  }
}

double unitOf(double largest) {
  return largest > PixelUnits::kLargest
             ? std::ldexp(1., std::ilogb(largest) - std::ilogb(PixelUnits::kLargest))
             : 1.;
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

/// An image as the caller gives it; its size is checked.
struct GivenImage {
  std::size_t rowLength() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
  const float* row(std::size_t y) const { return pixels + rowLength() * y; }
  bool hasAlpha() const { return channels == 4; }

  const float* pixels;
  int width, height, channels;
  bool multiply;  ///< there is an alpha, by which colours are to be multiplied
};

GivenImage given(const float* pixels, int width, int height, int channels, bool premultiplied) {
  return {pixels, width, height, channels, channels == 4 && !premultiplied};
}

/// The largest magnitude of a row's colours after they are multiplied by alpha.
double largestProduct(const float* row, std::size_t length) {
  double largest = 0;
  for (std::size_t i = 0; i < length; i += 4) {
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(static_cast<double>(row[i + c]) * row[i + 3]));
    }
  }
  return largest;
}

/// Throws for pixels that are not finite.
PixelUnits unitsOf(const GivenImage& image, int threads) {
  struct Largest {
    double colour = 0, alpha = 0;
  };
  std::vector<Largest> rows(static_cast<std::size_t>(image.height));
  const auto read = [&](std::size_t y) {
    const std::array<float, 4> most = largestOf(image.row(y), image.rowLength());
    for (const float magnitude : most) {
      if (!std::isfinite(magnitude)) {
        refuseRow(image.row(y), static_cast<int>(y), image.channels);
      }
    }
    const float colour = std::max({most[0], most[1], most[2], image.hasAlpha() ? 0 : most[3]}),
                alpha = image.hasAlpha() ? most[3] : 1;
    const double bound = static_cast<double>(colour) * (image.multiply ? alpha : 1);
    rows[y] = {bound > PixelUnits::kLargest && image.multiply
                   ? largestProduct(image.row(y), image.rowLength())
                   : bound,
               alpha};
  };
  parallelFor(rows.size(), kRowsOfPixelsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      read(y);
    }
  });
  Largest largest;
  for (const Largest& row : rows) {
    largest.colour = std::max(largest.colour, row.colour);
    largest.alpha = std::max(largest.alpha, row.alpha);
  }
  return {unitOf(largest.colour), unitOf(largest.alpha)};
}

/// What the pyramid holds of an image.
PixelGrid copied(const GivenImage& image, const PixelUnits& units, int threads) {
  PixelGrid grid(image.width, image.height, image.channels);
  const bool is_scaled = units.colour != 1 || units.alpha != 1;
  const auto copyRow = [&](std::size_t y) {
    const float* const from = image.row(y);
    float* const to = grid.row(static_cast<int>(y));
    std::copy(from, from + image.rowLength(), to);
    for (std::size_t i = 0; image.multiply && i < image.rowLength(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        to[i + c] *= to[i + 3];
      }
    }
    for (std::size_t i = 0; is_scaled && i < image.rowLength(); ++i) {
      const bool is_alpha = image.hasAlpha() && i % 4 == 3;
      const double factor = image.multiply && !is_alpha ? from[i / 4 * 4 + 3] : 1;
      to[i] = static_cast<float>(factor * from[i] / (is_alpha ? units.alpha : units.colour));
    }
  };
  parallelFor(static_cast<std::size_t>(image.height), kRowsOfPixelsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) {
                  copyRow(y);
                }
              });
  return grid;
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
              unitsOf(given(pixels, width, height, channels, premultiplied), threads))),
      pyramid_(copied(given(pixels, width, height, channels, premultiplied), units_, threads),
               threads),
      extension_(extension) {
  units_.colour /= units_.alpha;
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
