// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/face_sizes.h"

#include <algorithm>

namespace limitsurf {

std::vector<double> faceSizes(const LimitSurface& surface, const std::vector<bool>& has_surface,
                              double scale, int threads) {
  constexpr int kSteps = 2, kSide = kSteps + 1;
  std::vector<Location> at;
  for (std::size_t face = 0; face < has_surface.size(); ++face) {
    for (int i = 0; has_surface[face] && i < kSide * kSide; ++i) {
      const int row = i / kSide, column = i % kSide;
      at.push_back({static_cast<int>(face), static_cast<double>(column) / kSteps,
                    static_cast<double>(row) / kSteps});
    }
  }
  const Points points = scale * surface.evaluate(at, Derivatives::none, false, threads).position;
  std::vector<double> sizes(has_surface.size(), -1);
  for (Eigen::Index first = 0; first < points.rows(); first += kSide * kSide) {
    double& size = sizes[static_cast<std::size_t>(at[static_cast<std::size_t>(first)].face)];
    for (int line = 0; line < kSide; ++line) {
      double along_u = 0, along_v = 0;
      for (int i = 0; i < kSteps; ++i) {
        const auto point = [&](int x, int y) { return points.row(first + kSide * y + x); };
        along_u += (point(i + 1, line) - point(i, line)).norm();
        along_v += (point(line, i + 1) - point(line, i)).norm();
      }
      size = std::max({size, along_u, along_v});
    }
  }
  return sizes;
}

}  // namespace limitsurf
