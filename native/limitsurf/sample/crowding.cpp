// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/crowding.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPointsPerTask = 1024;

}  // namespace

Crowding::Crowding(const Box& box, std::vector<NoisePoint> points, int threads)
    : box_(box), points_(std::move(points)), threads_(threads) {}

DiscGrid Crowding::grid() const {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const NoisePoint& point : points_) {
    smallest = std::min(smallest, kReach * point.radius);
    largest = std::max(largest, kReach * point.radius);
  }
  DiscGrid grid(box_, smallest, largest);
  for (const NoisePoint& point : points_) {
    grid.insert(point.position, kReach * point.radius);
  }
  return grid;
}

template <typename Visit>
void Crowding::forEachNeighbour(const DiscGrid& grid, std::size_t point, const Visit& visit) const {
  const NoisePoint& own = points_[point];
  grid.any(own.position, kReach * own.radius, [&](int number) {
    const std::size_t other = static_cast<std::size_t>(number);
    if (other != point && seeEachOther(own.normal, points_[other].normal)) {
      const double distance = length(Vector3(points_[other].position - own.position));
      visit(other, 2 * distance / (own.radius + points_[other].radius));
    }
    return false;
  });
}

void Crowding::thin(std::size_t count) {
  while (points_.size() > count) {
    const DiscGrid all = grid();
    std::vector<double> crowds(points_.size());
    parallelFor(crowds.size(), kPointsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        double crowd = 0;
        forEachNeighbour(all, i, [&](std::size_t, double distance) {
          const double closeness = std::max(kReach - distance, 0.);
          crowd += closeness * closeness;
        });
        crowds[i] = crowd;
      }
    });
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return crowds[a] != crowds[b] ? crowds[a] > crowds[b] : a < b;
    });
    // No two neighbours are removed at a time: without the one the other is crowded no longer.
    std::vector<char> is_removed(points_.size(), 0), has_lost(points_.size(), 0);
    std::size_t left = points_.size();
    for (const std::size_t i : order) {
      if (left == count) {
        break;
      }
      if (!has_lost[i]) {
        is_removed[i] = 1;
        --left;
        forEachNeighbour(all, i, [&](std::size_t other, double) { has_lost[other] = 1; });
      }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!is_removed[i]) {
        points_[kept++] = points_[i];
      }
    }
    points_.resize(kept);
  }
}

double Crowding::slack() const {
  const DiscGrid all = grid();
  std::vector<double> closest(points_.size());
  parallelFor(closest.size(), kPointsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      closest[i] = kReach;
      forEachNeighbour(all, i, [&](std::size_t, double distance) {
        closest[i] = std::min(closest[i], distance);
      });
    }
  });
  return *std::min_element(closest.begin(), closest.end());
}

}  // namespace limitsurf
