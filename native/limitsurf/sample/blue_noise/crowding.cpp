// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/crowding.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPointsPerTask = 1024;
/// Crowding is summed up in whole numbers of 1 / kUnit, so that the order does not matter.
constexpr double kUnit = std::int64_t{1} << 50;

}  // namespace

Crowding::Crowding(const Box& box, NoisePoints points, int threads)
    : box_(box), points_(std::move(points)), threads_(threads) {}

DiscGrid Crowding::grid() const {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const NoiseDisc& disc : points_.discs) {
    smallest = std::min(smallest, kReach * disc.radius);
    largest = std::max(largest, kReach * disc.radius);
  }
  std::vector<NoiseDisc> discs = points_.discs;
  for (NoiseDisc& disc : discs) {
    disc.radius *= kReach;
  }
  DiscGrid grid(box_, smallest, largest);
  grid.insert({discs}, threads_);
  return grid;
}

template <typename Visit>
void Crowding::forEachNeighbour(const DiscGrid& grid, std::size_t point, const Visit& visit) const {
  const NoiseDisc& own = points_.discs[point];
  grid.any(own.position, kReach * own.radius, [&](int number) {
    const std::size_t other = static_cast<std::size_t>(number);
    const NoiseDisc& disc = points_.discs[other];
    if (other != point && seeEachOther(own.normal, disc.normal)) {
      const double distance = length(Vector3(disc.position - own.position));
      visit(other, 2 * distance / (own.radius + disc.radius));
    }
    return false;
  });
}

void Crowding::thin(std::size_t count) {
  while (points_.at.size() > count) {
    const DiscGrid all = grid();
    std::vector<std::int64_t> crowds(points_.at.size());
    parallelFor(crowds.size(), kPointsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::int64_t crowd = 0;
        forEachNeighbour(all, i, [&](std::size_t, double distance) {
          const double closeness = std::max(kReach - distance, 0.);
          crowd += static_cast<std::int64_t>(kUnit * closeness * closeness);
        });
        crowds[i] = crowd;
      }
    });
    std::vector<std::size_t> order(points_.at.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return crowds[a] != crowds[b] ? crowds[a] > crowds[b] : a < b;
    });
    // No two neighbours are removed at a time: without the one the other is crowded no longer.
    std::vector<char> is_removed(points_.at.size(), 0), has_lost(points_.at.size(), 0);
    std::size_t left = points_.at.size();
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
    for (std::size_t i = 0; i < points_.at.size(); ++i) {
      if (!is_removed[i]) {
        points_.discs[kept] = points_.discs[i];
        points_.at[kept++] = points_.at[i];
      }
    }
    points_.discs.resize(kept);
    points_.at.resize(kept);
  }
}

double Crowding::slack() const {
  const DiscGrid all = grid();
  std::vector<double> closest(points_.at.size());
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
