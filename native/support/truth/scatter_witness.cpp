// SPDX-License-Identifier: Apache-2.0
#include "support/truth/scatter_witness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"

namespace limitsurf::test {

Cage scatteredCage() {
  Cage cage = mixture(3);
  Random random(5);
  sharpenAtRandom(cage, random, 6, 12, {0.7, 1.5, 3, 10});
  return bent(cage);
}

Cage bent(Cage cage) {
  const Eigen::RowVector3d low = cage.positions.colwise().minCoeff();
  const double size = (cage.positions.colwise().maxCoeff() - low).maxCoeff();
  for (Eigen::Index i = 0; i < cage.positions.rows(); ++i) {
    const Eigen::RowVector3d p = (cage.positions.row(i) - low) / size;
    cage.positions.row(i) << p[0] + p[0] * p[0] + 0.3 * p[1], p[1],
        0.4 * std::sin(4 * p[0]) + 0.5 * p[1] * p[1] + p[2];
  }
  return cage;
}

std::vector<double> areas(const LimitSurface& surface, int side, int points, const Weight& weight) {
  const int per_face = side * points;
  std::vector<double> result(static_cast<std::size_t>(surface.faceCount()) * side * side, 0);
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[face]) != 0) continue;
    std::vector<Location> at;
    for (int y = 0; y < per_face; ++y) {
      for (int x = 0; x < per_face; ++x) {
        at.push_back({face, (x + 0.5) / per_face, (y + 0.5) / per_face});
      }
    }
    const Evaluation values = surface.evaluate(at, Derivatives::first);
    for (int i = 0; i < per_face * per_face; ++i) {
      const Vector3 du = values.du.row(i), dv = values.dv.row(i);
      const int square = (face * side + i / per_face / points) * side + i % per_face / points;
      result[square] += du.cross(dv).norm() / (per_face * per_face) * (weight ? weight(at[i]) : 1);
    }
  }
  return result;
}

std::vector<double> counts(const LimitSurface& surface, const std::vector<Location>& at, int side) {
  std::vector<double> result(static_cast<std::size_t>(surface.faceCount()) * side * side, 0);
  for (const Location& location : at) {
    const int column = std::min(static_cast<int>(location.u * side), side - 1);
    const int row = std::min(static_cast<int>(location.v * side), side - 1);
    ++result[(location.face * side + row) * side + column];
  }
  return result;
}

double chiSquareDeviation(const std::vector<double>& counts, const std::vector<double>& expected) {
  double all = 0, total = 0;
  for (const double count : counts) all += count;
  for (const double share : expected) total += share;
  double chi = 0;
  int bins = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double share = all * expected[i] / total;
    if (share == 0) {
      EXPECT_EQ(counts[i], 0) << "bin " << i;
      continue;
    }
    chi += (counts[i] - share) * (counts[i] - share) / share;
    ++bins;
  }
  const double freedom = bins - 1;
  return (chi - freedom) / std::sqrt(2 * freedom);
}

PointCloud::PointCloud(const LimitSurface& surface, const std::vector<Location>& at, double side)
    : all_(surface.evaluate(at, Derivatives::first, true)), side_(side) {
  for (Eigen::Index i = 0; i < all_.position.rows(); ++i) {
    cubes_[key(all_.position.row(i), 0, 0, 0)].push_back(static_cast<int>(i));
  }
}

std::int64_t PointCloud::key(const Vector3& position, int dx, int dy, int dz) const {
  const auto index = [&](int axis) {
    return static_cast<std::int64_t>(std::floor(position[axis] / side_)) + (1 << 20);
  };
  return ((index(0) + dx) << 42) | ((index(1) + dy) << 21) | (index(2) + dz);
}

void PointCloud::near(const Vector3& position,
                      const std::function<void(int, double)>& visit) const {
  for (int cube = 0; cube < 27; ++cube) {
    const auto found = cubes_.find(key(position, cube % 3 - 1, cube / 3 % 3 - 1, cube / 9 - 1));
    if (found == cubes_.end()) continue;
    for (const int point : found->second) {
      const double distance = (all_.position.row(point).transpose() - position).norm();
      if (distance < side_) visit(point, distance);
    }
  }
}

}  // namespace limitsurf::test
