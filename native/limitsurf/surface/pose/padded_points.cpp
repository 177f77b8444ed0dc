// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/pose/padded_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Tasks take 100 microseconds. Small meshes are one task, because waking other cores would take as
/// long.
constexpr std::size_t kPointsPerTask = 65536;

/// The bounding box of some points.
struct Box {
  double low[3], high[3];

  Box() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::fill_n(low, 3, kInfinity);
    std::fill_n(high, 3, -kInfinity);
  }
  void include(const double least[3], const double most[3]) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], least[c]);
      high[c] = std::max(high[c], most[c]);
    }
  }
};

}  // namespace

PointsSize padPoints(const RowsIn<Points>& from, Padded* to, int threads) {
  const auto count = static_cast<std::size_t>(from.rows());
  std::vector<Box> parts((count + kPointsPerTask - 1) / kPointsPerTask);
  parallelFor(count, kPointsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    Box part;
    for (std::size_t i = begin; i < end; ++i) {
      const double* const point = from.data() + 3 * i;
      double* const padded = to[i].data();
      padded[0] = point[0], padded[1] = point[1], padded[2] = point[2], padded[3] = 0;
      part.include(point, point);
    }
    parts[begin / kPointsPerTask] = part;
  });
  Box box;
  for (const Box& part : parts) {
    box.include(part.low, part.high);
  }
  PointsSize size;
  for (int c = 0; c < 3 && count > 0; ++c) {
    size.extent = std::max(size.extent, box.high[c] - box.low[c]);
    size.largest_coordinate =
        std::max({size.largest_coordinate, std::abs(box.low[c]), std::abs(box.high[c])});
  }
  return size;
}

}  // namespace limitsurf
