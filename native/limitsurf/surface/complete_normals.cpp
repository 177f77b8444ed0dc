// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/complete_normals.h"

#include <vector>

#include "limitsurf/parallel.h"

namespace limitsurf {

void completeNormals(const LimitSurface& surface, const LocationBatch& at,
                     Eigen::Ref<Points> normal, int threads) {
  constexpr std::size_t kRowsPerPart = 16384;
  const auto count = static_cast<std::size_t>(normal.rows());
  std::vector<std::vector<Eigen::Index>> parts((count + kRowsPerPart - 1) / kRowsPerPart);
  parallelFor(count, kRowsPerPart, threads, [&](std::size_t begin, std::size_t end) {
    for (auto row = static_cast<Eigen::Index>(begin); row < static_cast<Eigen::Index>(end); ++row) {
      if (!normal.row(row).allFinite()) {
        parts[begin / kRowsPerPart].push_back(row);
      }
    }
  });
  std::vector<Location> without;
  std::vector<Eigen::Index> rows;
  for (const std::vector<Eigen::Index>& part : parts) {
    for (const Eigen::Index row : part) {
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
