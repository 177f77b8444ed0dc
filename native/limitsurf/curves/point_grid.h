// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// Points by the cells of a cubic grid, for finding those near a place.
class PointGrid {
 public:
  PointGrid(const Points& points, double cell);

  /// The numbers of all points in the cells that are at most `reach` away, which is at most a cell,
  /// in increasing order.
  void near(const Vector3& place, double reach, std::vector<int>& out) const;

 private:
  std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const;

  double cell_;
  Vector3 origin_ = Vector3::Zero();
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

}  // namespace limitsurf
