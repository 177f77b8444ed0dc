// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/sample/blue_noise/poisson_disc_sampling.h"

namespace limitsurf {

/// The crowding of points: how close they are to each other, up to kReach times their radii.
class Crowding {
 public:
  static constexpr double kReach = 1.5;

  Crowding(const Box& box, NoisePoints points, int threads);

  /// Removes the most crowded points until `count` are left.
  void thin(std::size_t count);
  /// The largest factor, at most kReach, by which all radii can be multiplied without a conflict.
  double slack() const;

  NoisePoints& points() { return points_; }

 private:
  DiscGrid grid() const;
  /// Calls visit(other, distance / mean of both radii) for each neighbour that a point sees.
  template <typename Visit>
  void forEachNeighbour(const DiscGrid& grid, std::size_t point, const Visit& visit) const;

  Box box_;
  NoisePoints points_;
  int threads_;
};

}  // namespace limitsurf
