// SPDX-License-Identifier: Apache-2.0
#include "support/witness.h"

#include <Eigen/Geometry>
#include <cmath>
#include <set>

namespace limitsurf::test {
namespace {

/// Where the faces' scales are taken, as near to the corners as the promise allows and in between.
constexpr double kScaleUv[][2] = {
    {0x1p-4, 0x1p-4}, {0x1p-4, 0},  {0, 0x1p-4}, {15 * 0x1p-4, 15 * 0x1p-4},
    {0.5, 0.5},       {0.5, 0},     {0, 0.5},    {1, 0.5},
    {0.5, 1},         {0.25, 0.75},
};

/// du and dv too parallel for the double nearest to each to fix their normal to kNormalError.
bool almostParallel(const Vector3& du, const Vector3& dv) {
  return du.normalized().cross(dv.normalized()).norm() < 1e-3;
}

}  // namespace

void compareWithSubdivision(const std::string& name, const Cage& cage,
                            const std::vector<Location>& at, Accuracy& all) {
  const LimitSurface surface = limitSurface(cage);
  const CornerPoints corners(cage);
  DeepSubdivision deep(cage);
  Accuracy accuracy(name, diagonal(cage.positions));

  std::set<int> faces;
  for (const Location& location : at) faces.insert(location.face);
  for (int face : faces) {
    for (const double* uv : kScaleUv) {
      const Location location = {face, uv[0], uv[1]};
      accuracy.addScale(location, deep.evaluate(location));
    }
  }
  std::vector<Evaluation> evaluations;
  for (Derivatives order : kOrders) {
    evaluations.push_back(surface.evaluate(at, order, order != Derivatives::none));
  }
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const CornerPoint* point = corners.at(at[i]);
    Truth truth;
    if (point != nullptr && !point->regular()) {
      truth.values.fill(Vector3::Constant(NAN));
      const int corner = at[i].v > 0 ? (at[i].u > 0 ? 2 : 3) : at[i].u > 0;
      truth.values[kPosition] = deep.cornerPosition(at[i].face, corner);
    } else {
      truth = deep.evaluate(at[i]);
      if (corners.insideSmoothCorner(at[i]) || almostParallel(truth[kDu], truth[kDv])) {
        truth.values[kNormal].setConstant(NAN);
      }
    }
    for (int order = 0; order < 3; ++order) {
      accuracy.check(at[i], rowOf(evaluations[order], i), upTo(kOrders[order], truth));
    }
  }
  all.merge(accuracy);
}

std::vector<Location> shells(int face, int corner, const std::vector<int>& n) {
  // Twelve binary digits: enough that no product of weights is exact by luck, few enough that
  // 1 - u is.
  constexpr double a = 3277 / 4096.0, b = 2459 / 4096.0, c = 1433 / 4096.0;
  constexpr double directions[][2] = {{1, 1}, {a, a}, {a, c}, {b, a},
                                      {1, b}, {c, 1}, {a, 0}, {0, b}};
  const Location origin = cornerLocation(face, corner);
  std::vector<Location> result;
  for (int level : n) {
    const double t = std::ldexp(1.0, -level);
    for (const auto& [du, dv] : directions) {
      result.push_back({face, std::abs(origin.u - du * t), std::abs(origin.v - dv * t)});
    }
  }
  return result;
}

std::vector<Location> anywhere(int face, int count, Random& random) {
  std::vector<Location> result;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform(), v = random.uniform();
    result.push_back({face, u, v});
  }
  return result;
}

void operator+=(std::vector<Location>& locations, const std::vector<Location>& more) {
  locations.insert(locations.end(), more.begin(), more.end());
}

}  // namespace limitsurf::test
