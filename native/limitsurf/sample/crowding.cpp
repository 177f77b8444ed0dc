// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/crowding.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kDartsPerTask = 1024;

}  // namespace

Crowding::Crowding(const Box& box, std::vector<Dart> darts, int threads)
    : box_(box), darts_(std::move(darts)), threads_(threads) {}

DiscGrid Crowding::grid() const {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const Dart& dart : darts_) {
    smallest = std::min(smallest, kReach * dart.radius);
    largest = std::max(largest, kReach * dart.radius);
  }
  DiscGrid grid(box_, smallest, largest);
  for (const Dart& dart : darts_) {
    grid.insert(dart.position, kReach * dart.radius);
  }
  return grid;
}

template <typename Visit>
void Crowding::forEachNeighbour(const DiscGrid& grid, std::size_t dart, const Visit& visit) const {
  const Dart& own = darts_[dart];
  grid.any(own.position, kReach * own.radius, [&](int number) {
    const std::size_t other = static_cast<std::size_t>(number);
    if (other != dart && seeEachOther(own.normal, darts_[other].normal)) {
      const double distance = length(Vector3(darts_[other].position - own.position));
      visit(other, 2 * distance / (own.radius + darts_[other].radius));
    }
    return false;
  });
}

void Crowding::thin(std::size_t count) {
  while (darts_.size() > count) {
    const DiscGrid all = grid();
    std::vector<double> crowds(darts_.size());
    parallelFor(crowds.size(), kDartsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        double crowd = 0;
        forEachNeighbour(all, i, [&](std::size_t, double distance) {
          const double closeness = std::max(kReach - distance, 0.);
          crowd += closeness * closeness;
        });
        crowds[i] = crowd;
      }
    });
    std::vector<std::size_t> order(darts_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return crowds[a] != crowds[b] ? crowds[a] > crowds[b] : a < b;
    });
    // Not two neighbours at a time: without the one the other is not crowded any more.
    std::vector<char> is_removed(darts_.size(), 0), has_lost(darts_.size(), 0);
    std::size_t left = darts_.size();
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
    for (std::size_t i = 0; i < darts_.size(); ++i) {
      if (!is_removed[i]) {
        darts_[kept++] = darts_[i];
      }
    }
    darts_.resize(kept);
  }
}

double Crowding::slack() const {
  const DiscGrid all = grid();
  std::vector<double> closest(darts_.size());
  parallelFor(closest.size(), kDartsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
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
