// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/point_grid.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

/// Cells have 21 bits along each axis.
constexpr std::int64_t kMostCells = std::int64_t{1} << 21;

}  // namespace

PointGrid::PointGrid(const Points& points, double cell) : cell_(cell) {
  if (points.rows() == 0) {
    return;
  }
  origin_ = points.colwise().minCoeff();
  const double extent = (points.colwise().maxCoeff().transpose() - origin_).maxCoeff();
  cell_ = std::max(cell_, 4 * extent / static_cast<double>(kMostCells));
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3 at = (points.row(i).transpose() - origin_) / cell_;
    cells_[key(static_cast<std::int64_t>(at[0]), static_cast<std::int64_t>(at[1]),
               static_cast<std::int64_t>(at[2]))]
        .push_back(static_cast<int>(i));
  }
}

void PointGrid::near(const Vector3& place, double reach, std::vector<int>& out) const {
  out.clear();
  const double limit = static_cast<double>(kMostCells);
  std::int64_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double at = place[axis] - origin_[axis];
    low[axis] = static_cast<std::int64_t>(std::clamp(std::floor((at - reach) / cell_), 0., limit));
    high[axis] =
        static_cast<std::int64_t>(std::clamp(std::floor((at + reach) / cell_), -1., limit));
  }
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        const auto found = cells_.find(key(x, y, z));
        if (found != cells_.end()) {
          out.insert(out.end(), found->second.begin(), found->second.end());
        }
      }
    }
  }
  std::sort(out.begin(), out.end());
}

std::int64_t PointGrid::key(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return (z * kMostCells + y) * kMostCells + x;
}

}  // namespace limitsurf
