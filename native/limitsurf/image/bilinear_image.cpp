// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/bilinear_image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPlacesPerTask = 4096;

/// The two pixels around a place along one axis, and the part of the way from the first to the
/// second.
struct Between {
  Between(double place, int count) {
    const double along = std::clamp(place * count - 0.5, 0.0, count - 1.0);
    first = static_cast<int>(along);
    second = std::min(first + 1, count - 1);
    part = along - first;
  }
  int first, second;
  double part;
};

}  // namespace

DataRows BilinearImage::sample(const Eigen::Ref<const Places>& places, int threads) const {
  checkThreads(threads);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < places.rows(); ++row) {
    stride.step();
    if (!places.row(row).allFinite()) {
      throw std::invalid_argument("row " + std::to_string(row) + ": st (" +
                                  numberText(places(row, 0)) + ", " + numberText(places(row, 1)) +
                                  ") is not finite");
    }
  }
  using Pixel = Eigen::Map<const Eigen::RowVectorXf>;
  const auto pixel = [&](int x, int y) {
    return Pixel(pixels + (static_cast<std::size_t>(y) * width + x) * channels, channels)
        .cast<double>();
  };
  DataRows result(places.rows(), channels);
  const auto sampleRows = [&](std::size_t begin, std::size_t end) {
    for (auto row = static_cast<Eigen::Index>(begin); row < static_cast<Eigen::Index>(end); ++row) {
      const Between x(places(row, 0), width), y(places(row, 1), height);
      result.row(row) =
          (1 - y.part) *
              ((1 - x.part) * pixel(x.first, y.first) + x.part * pixel(x.second, y.first)) +
          y.part * ((1 - x.part) * pixel(x.first, y.second) + x.part * pixel(x.second, y.second));
    }
  };
  parallelFor(static_cast<std::size_t>(places.rows()), kPlacesPerTask, threads, sampleRows);
  return result;
}

}  // namespace limitsurf
