// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

/// Curved, with extraordinary vertices of several valences, creases of all kinds, boundaries, holes
/// and n-gons.
Cage scatteredCage();

/// Bends and shears it: faces of very different sizes and shapes, and areas that vary within each.
Cage bent(Cage cage);

/// Integrals over each of side x side squares of each Ptex face, [face][row][column], by the
/// midpoint rule on so many points a square: of area, times `weight` where there is one. Faces
/// without a surface have 0.
using Weight = std::function<double(const Location& at)>;
std::vector<double> areas(const LimitSurface& surface, int side, int points,
                          const Weight& weight = {});

/// How many locations lie in each of these squares.
std::vector<double> counts(const LimitSurface& surface, const std::vector<Location>& at, int side);

/// By how many standard deviations chi-square exceeds (or falls below) its mean, if counts have the
/// expected proportions. Expects nothing where nothing is expected.
double chiSquareDeviation(const std::vector<double>& counts, const std::vector<double>& expected);

/// Points on a surface, found by where they are.
class PointCloud {
 public:
  /// Cubes of `side`.
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
