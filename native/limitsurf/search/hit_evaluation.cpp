// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/hit_evaluation.h"

#include <limits>

#include "limitsurf/large_pages.h"
#include "limitsurf/surface/batch/part_evaluator.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Evaluates those of some locations whose face is not -1.
class HitEvaluator {
 public:
  HitEvaluator(const LimitSurface& surface, std::size_t count, int threads)
      : evaluate_(surface, count, threads) {}

  void operator()(Span<Location> part, double* position, double* normal) {
    found_.clear();
    for (const Location& location : part) {
      if (location.face >= 0) {
        found_.push_back(location);
      }
    }
    if (found_.size() == part.size()) {
      evaluate_(part, position, normal);
      return;
    }
    const auto found = static_cast<Eigen::Index>(found_.size());
    if (position_.rows() < found) {
      position_.resize(found, 3);
      normal_.resize(found, 3);
    }
    evaluate_(found_, position_.data(), normal_.data());
    std::size_t next = 0;
    for (std::size_t row = 0; row < part.size(); ++row) {
      const bool is_found = part[row].face >= 0;
      for (std::size_t k = 3 * row; k < 3 * row + 3; ++k) {
        position[k] = is_found ? position_.data()[next] : kNaN;
        normal[k] = is_found ? normal_.data()[next] : kNaN;
        next += is_found ? 1 : 0;
      }
    }
  }

 private:
  PartEvaluator evaluate_;
  std::vector<Location> found_;
  Points position_, normal_;
};

}  // namespace

void completeHits(const LimitSurface& surface, Hits& hits, int threads) {
  const std::size_t count = hits.at.size();
  resizeRows(hits.position, count);
  resizeRows(hits.normal, count);
  resizeRows(hits.distance, count);
  HitEvaluator evaluate(surface, count, threads);
  forEachPart(hits.at, [&](std::size_t begin, Span<Location> part) {
    evaluate(part, hits.position.data() + 3 * begin, hits.normal.data() + 3 * begin);
  });
  for (Location& location : hits.at) {
    if (location.face < 0) {
      location.u = location.v = kNaN;
    }
  }
}

}  // namespace limitsurf
