// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/complete_normals.h"

#include <vector>

namespace limitsurf {

void completeNormals(const LimitSurface& surface, const LocationBatch& at, Points& normal,
                     int threads) {
  std::vector<Location> without;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < normal.rows(); ++row) {
    if (!normal.row(row).allFinite()) {
      without.push_back(at[static_cast<std::size_t>(row)]);
      rows.push_back(row);
    }
  }
  const auto frames = surface.frames(without, threads);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto frame = frames.row(static_cast<Eigen::Index>(i));
    normal.row(rows[i]) << frame[2], frame[5], frame[8];
  }
}

}  // namespace limitsurf
