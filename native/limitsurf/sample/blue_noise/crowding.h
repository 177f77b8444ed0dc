// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/blue_noise/poisson_disc_sampling.h"

namespace limitsurf {

/// The crowding of points: how close they are to each other, up to kReach times their radii.
class Crowding {
 public:
  static constexpr double kReach = 1.5;

  Crowding(const Box& box, NoisePoints points, int threads);

  /// Removes the most crowded points until `count` are left. Returns the largest factor, at most
  /// kReach, by which all their radii can be multiplied without a conflict.
  double thin(std::size_t count);

  NoisePoints& points() { return points_; }

 private:
  DiscGrid grid() const;
  /// Sorts points from the most crowded one on, as far as they come to lie in [begin, end) of the
  /// order. Those before `begin` are sorted already.
  static void sortMostCrowded(const std::vector<std::int64_t>& crowds, std::size_t begin,
                              std::size_t end, std::vector<std::size_t>& order);
  /// The distance from a point to its closest neighbour that is not removed.
  double closestLeft(const DiscGrid& grid, std::size_t point,
                     const std::vector<char>& is_removed) const;
  /// Calls visit(other, distance / mean of both radii) for each neighbour that a point sees.
  template <typename Visit>
  void forEachNeighbour(const DiscGrid& grid, std::size_t point, const Visit& visit) const;

  Box box_;
  NoisePoints points_;
  int threads_;
};

}  // namespace limitsurf
