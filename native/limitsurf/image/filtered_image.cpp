// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/filtered_image.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "limitsurf/image/image_lookup.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPlacesPerTask = 256, kRowsOfPixelsPerTask = 16;

[[noreturn]] void refusePixel(int x, int y, int channel, float value) {
  std::ostringstream message;
  message << "pixel (" << x << ", " << y << "): channel " << channel << " is " << value
          << "; pixels must be finite";
  throw std::invalid_argument(message.str());
}

/// A copy of the pixels. With `multiply` their colours are multiplied by alpha, if they have one.
PixelGrid copied(const float* pixels, int width, int height, int channels, bool multiply,
                 int threads) {
  if (width < 1 || height < 1 || channels < 1 || channels > 4) {
    throw std::invalid_argument("an image of " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels of " + std::to_string(channels) +
                                " channels; expected at least 1 x 1 pixels of 1 to 4 channels");
  }
  PixelGrid image(width, height, channels);
  std::vector<int> not_finite(static_cast<std::size_t>(height), -1);
  parallelFor(static_cast<std::size_t>(height), kRowsOfPixelsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) {
                  const float* from = pixels + image.rowLength() * y;
                  float* to = image.row(static_cast<int>(y));
                  for (std::size_t i = 0; i < image.rowLength(); ++i) {
                    if (!std::isfinite(from[i]) && not_finite[y] < 0) {
                      not_finite[y] = static_cast<int>(i);
                    }
                    to[i] = from[i];
                  }
                  for (std::size_t i = 0; multiply && channels == 4 && i < image.rowLength();
                       i += 4) {
                    for (std::size_t c = 0; c < 3; ++c) {
                      to[i + c] *= to[i + 3];
                    }
                  }
                }
              });
  for (int y = 0; y < height; ++y) {
    const int i = not_finite[static_cast<std::size_t>(y)];
    if (i >= 0) {
      refusePixel(
          i / channels, y, i % channels,
          pixels[image.rowLength() * static_cast<std::size_t>(y) + static_cast<std::size_t>(i)]);
    }
  }
  return image;
}

template <int kChannels>
void sampleRows(const ImagePyramid& pyramid, Extension extension, const ImagePoints& st,
                const Footprints& footprint, Eigen::Index begin, Eigen::Index end, Colours& out) {
  const ImageLookup<kChannels> lookup(pyramid, extension);
  for (Eigen::Index i = begin; i < end; ++i) {
    if (st.row(i).hasNaN()) {
      out.row(i).setZero();
    } else {
      lookup.sample(st.row(i).data(), footprint.row(i).data(), out.row(i).data());
    }
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
    : pyramid_(
          (checkThreads(threads), copied(pixels, width, height, channels, !premultiplied, threads)),
          threads),
      extension_(extension) {}

Colours FilteredImage::sample(const ImagePoints& st, const Footprints& footprint,
                              int threads) const {
  checkThreads(threads);
  checkSamples(st, footprint);
  Colours out(st.rows(), channels());
  const auto rows = [&](auto channel_count) {
    parallelFor(static_cast<std::size_t>(st.rows()), kPlacesPerTask, threads,
                [&](std::size_t begin, std::size_t end) {
                  sampleRows<channel_count()>(pyramid_, extension_, st, footprint,
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
