// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

/// A curved cage with extraordinary vertices of several valences, creases of all kinds, boundaries,
/// holes and n-gons.
Cage scatteredCage();

/// Bends and shears a cage, so that faces have very different sizes and shapes, and the area varies
/// within each.
Cage bent(Cage cage);

/// Integrals over each of side x side squares of each Ptex face, [face][row][column], by the
/// midpoint rule: of area, multiplied by `weight` if there is one. Faces without a surface have 0.
using Weight = std::function<double(const Location& at)>;
std::vector<double> areas(const LimitSurface& surface, int side, int points,
                          const Weight& weight = {});

/// The number of locations in each of these squares.
std::vector<double> counts(const LimitSurface& surface, const std::vector<Location>& at, int side);

/// The number of standard deviations by which chi-square exceeds (or falls below) its mean, if
/// counts have the expected proportions. Expects a count of 0 where the expected proportion is 0.
double chiSquareDeviation(const std::vector<double>& counts, const std::vector<double>& expected);

/// Points on a surface that can be found by their position.
class PointCloud {
 public:
  /// The points are sorted into cubes of this side.
  PointCloud(const LimitSurface& surface, const std::vector<Location>& at, double side);

  const Points& position() const { return all_.position; }
  const Points& normal() const { return all_.normal; }
  /// Calls visit(i, distance) for the points within `side`.
  void near(const Vector3& position,
            const std::function<void(int point, double distance)>& visit) const;

 private:
  std::int64_t key(const Vector3& position, int dx, int dy, int dz) const;

  Evaluation all_;
  double side_;
  std::unordered_map<std::int64_t, std::vector<int>> cubes_;
};

}  // namespace limitsurf::test
