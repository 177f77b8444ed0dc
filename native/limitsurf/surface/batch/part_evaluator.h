// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Evaluates positions and normals of up to kMostRows locations at a time. The memory for du and dv
/// serves all calls: fresh memory costs as much as filling it.
class PartEvaluator {
 public:
  static constexpr std::size_t kMostRows = std::size_t{1} << 16;

  /// For calls with up to `count` locations.
  PartEvaluator(const LimitSurface& surface, std::size_t count, int threads)
      : surface_(surface), threads_(threads) {
    const auto most = static_cast<Eigen::Index>(std::min(kMostRows, count));
    du_.resize(most, 3);
    dv_.resize(most, 3);
  }

  /// Writes a row of three numbers for each location.
  void operator()(const LocationBatch& part, double* position, double* normal) {
    const std::size_t count = part.size();
    const EvaluationArrays<double> results{
        {position, count}, {du_.data(), count}, {dv_.data(), count}, {}, {}, {}, {normal, count}};
    surface_.evaluate(part, Derivatives::first, results, threads_);
  }

 private:
  const LimitSurface& surface_;
  int threads_;
  Points du_, dv_;
};

/// Calls body(begin, part) for parts of the locations that a PartEvaluator takes.
template <typename Body>
void forEachPart(Span<Location> at, const Body& body) {
  for (std::size_t begin = 0; begin < at.size(); begin += PartEvaluator::kMostRows) {
    body(begin, at.subspan(begin, std::min(PartEvaluator::kMostRows, at.size() - begin)));
  }
}

}  // namespace limitsurf
