// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/dart_throwing.h"

namespace limitsurf {

/// How close darts are to each other, up to kReach times their radii.
class Crowding {
 public:
  static constexpr double kReach = 1.5;

  Crowding(const Box& box, std::vector<Dart> darts, int threads);

  /// Removes the most crowded ones until `count` are left.
  void thin(std::size_t count);
  /// All radii times this are kept too: at most kReach.
  double slack() const;

  std::vector<Dart>& darts() { return darts_; }

 private:
  DiscGrid grid() const;
  /// Calls visit(other, distance over the mean of the radii) for those that a dart sees.
  template <typename Visit>
  void forEachNeighbour(const DiscGrid& grid, std::size_t dart, const Visit& visit) const;

  Box box_;
  std::vector<Dart> darts_;
  int threads_;
};

}  // namespace limitsurf
