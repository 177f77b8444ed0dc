// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/displace/ptex_layout.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/error.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/surface/location_batch.h"

namespace limitsurf {
namespace {

/// The least integer whose square is not below the number.
int leastSquareRoot(int number) {
  int root = static_cast<int>(std::sqrt(static_cast<double>(number)));
  while (static_cast<long long>(root) * root < number) {
    ++root;
  }
  return root;
}

void requireResolution(int resolution) {
  const bool power_of_two = resolution > 0 && (resolution & (resolution - 1)) == 0;
  if (!power_of_two || resolution > PtexLayout::kMostResolution) {
    throw std::invalid_argument("resolution is " + std::to_string(resolution) +
                                "; expected a power of two, 1 to " +
                                std::to_string(PtexLayout::kMostResolution));
  }
}

}  // namespace

PtexLayout::PtexLayout(int faces, int resolution)
    : faces_(faces), resolution_(resolution), columns_(faces > 0 ? leastSquareRoot(faces) : 0) {
  if (faces < 1) {
    throw std::invalid_argument("face_count is " + std::to_string(faces) + "; expected 1 or more");
  }
  requireResolution(resolution);
  const long long side = static_cast<long long>(columns_) * (resolution + 1);
  if (side > kMostSide) {
    throw std::invalid_argument(std::to_string(faces) + " faces at a resolution of " +
                                std::to_string(resolution) + " need an image " +
                                std::to_string(side) + " pixels wide; the limit is " +
                                std::to_string(kMostSide));
  }
}

PtexLayout::Pixel PtexLayout::origin(int face) const {
  const int side = resolution_ + 1;
  return {face % columns_ * side, face / columns_ * side};
}

std::vector<PtexLayout::Pixel> PtexLayout::pixels() const {
  const int side = resolution_ + 1;
  std::vector<Pixel> result;
  result.reserve(static_cast<std::size_t>(faces_) * side * side);
  InterruptionStride stride;
  for (int face = 0; face < faces_; ++face) {
    const Pixel first = origin(face);
    for (int j = 0; j < side; ++j) {
      stride.step();
      for (int i = 0; i < side; ++i) {
        result.push_back({first.x + i, first.y + j});
      }
    }
  }
  return result;
}

std::vector<Location> PtexLayout::locations() const {
  const int side = resolution_ + 1;
  std::vector<Location> result;
  result.reserve(static_cast<std::size_t>(faces_) * side * side);
  InterruptionStride stride;
  for (int face = 0; face < faces_; ++face) {
    for (int j = 0; j < side; ++j) {
      stride.step();
      for (int i = 0; i < side; ++i) {
        result.push_back(
            {face, static_cast<double>(i) / resolution_, static_cast<double>(j) / resolution_});
      }
    }
  }
  return result;
}

Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> PtexLayout::mapCoordinates(
    Span<Location> at) const {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> result(at.size(), 2);
  InterruptionStride stride;
  for (std::size_t row = 0; row < at.size(); ++row) {
    stride.step();
    const Location& place = at[row];
    if (place.face < 0 || place.face >= faces_) {
      throw LocationError("row " + std::to_string(row) + ": face " + std::to_string(place.face) +
                          " is not among the " + std::to_string(faces_) + " Ptex faces");
    }
    checkParameters(place, row);
    const Pixel first = origin(place.face);
    result.row(static_cast<Eigen::Index>(row)) << (first.x + 0.5 + resolution_ * place.u) / width(),
        (first.y + 0.5 + resolution_ * place.v) / height();
  }
  return result;
}

}  // namespace limitsurf
