// SPDX-License-Identifier: Apache-2.0
#include "support/truth/witness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "limitsurf/surface/fixed/fixed_samples.h"
#include "support/truth/corner_points.h"

namespace limitsurf::test {
namespace {

/// The locations that determine the scales of the faces: as near to the corners as the bounds'
/// definition allows, and in between.
constexpr double kScaleUv[][2] = {
    {0x1p-4, 0x1p-4}, {0x1p-4, 0},  {0, 0x1p-4}, {15 * 0x1p-4, 15 * 0x1p-4},
    {0.5, 0.5},       {0.5, 0},     {0, 0.5},    {1, 0.5},
    {0.5, 1},         {0.25, 0.75},
};

/// Removes the quantities that have no limit, exactly at an irregular vertex.
void expectMissing(const std::string& where, const CornerPoint& corner, const Truth& got,
                   const Truth& limit) {
  for (int quantity = kDu; quantity <= kDvv; ++quantity) {
    if (!limit[quantity].hasNaN()) continue;
    EXPECT_TRUE(got[quantity].array().isNaN().all())
        << where << ": " << kQuantityNames[quantity] << " has no limit, but is "
        << got[quantity].transpose();
  }
  EXPECT_EQ(got[kNormal].allFinite(), corner.hasNormal())
      << where << ": the normal is " << got[kNormal].transpose();
}

/// Whether du and dv are too parallel, or of too different lengths (across a fold one of them
/// vanishes), for their values, rounded to double, to determine the normal to kNormalError. Where
/// both vanish, what is left of them is the rounding of the witness' 50 digits.
bool almostParallel(const Vector3& du, const Vector3& dv, double size) {
  const auto [shorter, longer] = std::minmax({du.stableNorm(), dv.stableNorm()});
  return longer < 1e-40 * size || shorter < 1e-3 * longer ||
         du.normalized().cross(dv.normalized()).norm() < 1e-3;
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
  std::vector<Evaluation> fixed;
  for (Derivatives order : {Derivatives::none, Derivatives::first}) {
    fixed.push_back(FixedSamples(surface, at, order).evaluate(cage.positions));
  }
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const CornerPoint* point = corners.at(at[i]);
    Truth truth;
    if (point != nullptr && !point->regular()) {
      truth = deep.corner(at[i].face, cornerAt(at[i]));
      expectMissing(name + ", " + describe(at[i]), *point, rowOf(evaluations[2], i), truth);
    } else {
      truth = deep.evaluate(at[i]);
      if (corners.insideSmoothCorner(at[i]) ||
          almostParallel(truth[kDu], truth[kDv], diagonal(cage.positions))) {
        truth.values[kNormal].setConstant(NAN);
      }
    }
    for (int order = 0; order < 3; ++order) {
      accuracy.check(at[i], rowOf(evaluations[order], i), upTo(kOrders[order], truth));
    }
    truth.values[kNormal].setConstant(NAN);
    for (int order = 0; order < 2; ++order) {
      accuracy.check(at[i], rowOf(fixed[order], i), upTo(kOrders[order], truth));
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

std::vector<Location> everywhere(const Cage& cage, const std::vector<int>& levels, int random_count,
                                 Random& random) {
  std::vector<Location> at;
  const int faces = static_cast<int>(ptexFaces(cage).size());
  for (int face = 0; face < faces; ++face) {
    for (int corner = 0; corner < 4; ++corner) {
      at.push_back(cornerLocation(face, corner));
      at += shells(face, corner, levels);
    }
    at += anywhere(face, random_count, random);
  }
  return at;
}

std::vector<Location> aroundFan(int faces, const std::vector<int>& levels, int count,
                                Random& random) {
  std::set<int> sectors;
  for (int sector : {0, 1, faces / 2, faces - 1}) {
    if (sector < faces) sectors.insert(sector);
  }
  std::vector<Location> at;
  for (int sector : sectors) {
    const int face = 4 * sector;  // with the vertex at (0, 0)
    at.push_back({face, 0, 0});
    at += shells(face, 0, levels);
    at += anywhere(face, count, random);
    for (int outer = 1; outer < 4; ++outer) at += anywhere(face + outer, 1, random);
  }
  return at;
}

std::vector<Location> hereAndThere(const Cage& cage, const std::vector<int>& levels, int count,
                                   Random& random) {
  std::vector<Location> at;
  const int faces = static_cast<int>(ptexFaces(cage).size());
  for (int face = 0; face < faces; ++face) {
    at.push_back(cornerLocation(face, random.below(4)));
    const std::vector<Location> near = shells(face, random.below(4), levels);
    for (int i = 0; i < count; ++i) {
      at.push_back(near[random.below(static_cast<int>(near.size()))]);
      const double side = random.below(2), along = random.uniform();
      at.push_back(random.below(2) == 0 ? Location{face, along, side}
                                        : Location{face, side, along});
    }
    at += anywhere(face, count, random);
  }
  return at;
}

void operator+=(std::vector<Location>& locations, const std::vector<Location>& more) {
  locations.insert(locations.end(), more.begin(), more.end());
}

}  // namespace limitsurf::test
