// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/hit_evaluation.h"

#include <limits>
#include <utility>

namespace limitsurf {

Hits hitsAt(const LimitSurface& surface, std::vector<Location> at, int threads) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Hits hits;
  hits.at = std::move(at);
  std::vector<Location> found;
  found.reserve(hits.at.size());
  for (Location& location : hits.at) {
    if (location.face >= 0) {
      found.push_back(location);
    } else {
      location.u = location.v = kNaN;
    }
  }
  Evaluation e = surface.evaluate(found, Derivatives::first, true, threads);
  if (found.size() == hits.at.size()) {
    hits.position = std::move(e.position);
    hits.normal = std::move(e.normal);
    return hits;
  }
  hits.position.setConstant(static_cast<Eigen::Index>(hits.at.size()), 3, kNaN);
  hits.normal = hits.position;
  Eigen::Index next = 0;
  for (std::size_t row = 0; row < hits.at.size(); ++row) {
    if (hits.at[row].face >= 0) {
      hits.position.row(static_cast<Eigen::Index>(row)) = e.position.row(next);
      hits.normal.row(static_cast<Eigen::Index>(row)) = e.normal.row(next);
      ++next;
    }
  }
  return hits;
}

}  // namespace limitsurf
