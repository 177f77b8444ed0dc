// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/crowding.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kPointsPerTask = 1024;
/// The number of points that are sorted by crowding at a time, for each that is to be removed:
/// those beside removed ones are passed over. Chosen, not derived.
constexpr std::size_t kSortedAtATime = 4;
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

double Crowding::thin(std::size_t count) {
  for (;;) {
    const std::size_t size = points_.at.size();
    const DiscGrid all = grid();
    std::vector<std::int64_t> crowds(size);
    std::vector<double> closest(size);
    parallelFor(size, kPointsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::int64_t crowd = 0;
        double least = kReach;
        forEachNeighbour(all, i, [&](std::size_t, double distance) {
          const double closeness = std::max(kReach - distance, 0.);
          crowd += static_cast<std::int64_t>(kUnit * closeness * closeness);
          least = std::min(least, distance);
        });
        crowds[i] = crowd;
        closest[i] = least;
      }
    });
    // No two neighbours are removed at a time: without the one the other is crowded no longer.
    std::vector<char> is_removed(size, 0), has_lost(size, 0);
    std::vector<std::size_t> order(size > count ? size : 0);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::size_t left = size, sorted = 0;
    for (std::size_t place = 0; left > count && place < size; ++place) {
      if (place == sorted) {
        sorted = std::min(size, sorted + kSortedAtATime * (size - count));
        sortMostCrowded(crowds, place, sorted, order);
      }
      const std::size_t i = order[place];
      if (!has_lost[i]) {
        is_removed[i] = 1;
        --left;
        forEachNeighbour(all, i, [&](std::size_t other, double) { has_lost[other] = 1; });
      }
    }
    double slack = kReach;
    for (std::size_t i = 0; left <= count && i < size; ++i) {
      if (!is_removed[i] && closest[i] < slack) {
        slack = std::min(slack, closestLeft(all, i, is_removed));
      }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i) {
      if (!is_removed[i]) {
        points_.discs[kept] = points_.discs[i];
        points_.at[kept++] = points_.at[i];
      }
    }
    points_.discs.resize(kept);
    points_.at.resize(kept);
    if (left <= count) {
      return slack;
    }
  }
}

void Crowding::sortMostCrowded(const std::vector<std::int64_t>& crowds, std::size_t begin,
                               std::size_t end, std::vector<std::size_t>& order) {
  const auto comes_before = [&](std::size_t a, std::size_t b) {
    return crowds[a] != crowds[b] ? crowds[a] > crowds[b] : a < b;
  };
  const auto at = [&](std::size_t place) {
    return order.begin() + static_cast<std::ptrdiff_t>(place);
  };
  if (end < order.size()) {
    std::nth_element(at(begin), at(end), order.end(), comes_before);
  }
  std::sort(at(begin), at(end), comes_before);
}

double Crowding::closestLeft(const DiscGrid& grid, std::size_t point,
                             const std::vector<char>& is_removed) const {
  double least = kReach;
  forEachNeighbour(grid, point, [&](std::size_t other, double distance) {
    if (!is_removed[other]) {
      least = std::min(least, distance);
    }
  });
  return least;
}

}  // namespace limitsurf
