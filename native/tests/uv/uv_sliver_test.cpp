// SPDX-License-Identifier: Apache-2.0
//
// Points on the borders of faces whose derivatives are parallel or vanish at a corner or along an
// edge. What was evaluated must be found, and nothing that the map does not reach.
#include <gtest/gtest.h>

#include <cmath>

#include "limitsurf/uv/uv_map.h"
#include "support/cages/meshes.h"
#include "support/truth/uv_images.h"

namespace limitsurf::test {
namespace {

constexpr double kPi2 = 6.283185307179586;

std::vector<std::int64_t> cornersOf(const Cage& cage, bool is_cut) {
  std::vector<std::int64_t> corners;
  for (const auto& face : cage.faces) {
    for (const int vertex : face) {
      corners.push_back(is_cut ? static_cast<std::int64_t>(corners.size()) : vertex);
    }
  }
  return corners;
}

/// Values that make slivers: few different ones, on few lines, equal ones, or all beside one line.
DataRows sliverValues(const Cage& cage, bool is_cut, int kind, Random& random) {
  const std::vector<std::int64_t> corners = cornersOf(cage, is_cut);
  std::vector<int> vertices;
  for (const auto& face : cage.faces) vertices.insert(vertices.end(), face.begin(), face.end());
  DataRows values(is_cut ? static_cast<Eigen::Index>(corners.size()) : cage.vertexCount(), 2);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const auto vertex = is_cut ? vertices[static_cast<std::size_t>(i)] : static_cast<int>(i);
    const double along = random.uniform();
    switch (kind) {
      case 0:
        values.row(i) << random.below(3), random.below(3);
        break;
      case 1:
        values.row(i) << 0.1 * random.below(10), random.below(2);
        break;
      case 2:
        values.row(i) = cage.positions.row(vertex).head<2>();
        if (random.below(3) == 0) values.row(i) = values.row(random.below(i + 1));
        break;
      case 3:
        values.row(i) << along, 0.5 * along + 0.01 * random.below(3);
        break;
      default:
        values.row(i) << random.uniform(), random.uniform();
    }
  }
  return values;
}

/// Places on the sides of all faces, at all distances from their corners.
std::vector<Location> placesOnSides(int faces, int count, Random& random) {
  std::vector<Location> at;
  for (int face = 0; face < faces; ++face) {
    for (int i = 0; i < count; ++i) {
      const double near = std::exp2(random.uniform(-30, 0));
      const double along = i % 3 == 0 ? random.uniform() : i % 3 == 1 ? near : 1 - near;
      const Location places[] = {
          {face, along, 0}, {face, along, 1}, {face, 0, along}, {face, 1, along}};
      at.push_back(places[random.below(4)]);
    }
  }
  return at;
}

/// Whether the images of faces have an area.
std::vector<bool> haveArea(const SurfaceData& map) {
  std::vector<Location> inside;
  for (int face = 0; face < map.faceCount(); ++face) {
    for (int i = 0; i < 25; ++i) {
      inside.push_back({face, (i % 5 + 0.5) / 5, (i / 5 + 0.5) / 5});
    }
  }
  const DataEvaluation at = map.evaluate(inside, Derivatives::first);
  std::vector<bool> result(static_cast<std::size_t>(map.faceCount()));
  for (Eigen::Index i = 0; i < at.du.rows(); ++i) {
    const double area = at.du(i, 0) * at.dv(i, 1) - at.du(i, 1) * at.dv(i, 0);
    if (std::abs(area) > 1e-6) result[static_cast<std::size_t>(i / 25)] = true;
  }
  return result;
}

/// The diagonal of the box around values of the map and (0, 0).
double extentOf(const DataRows& values) {
  return (values.colwise().maxCoeff().cwiseMax(0) - values.colwise().minCoeff().cwiseMin(0)).norm();
}

TEST(UvSlivers, PointsOnSidesAreFound) {
  const Cage cages[] = {grid(1, 1),       grid(3, 2), fan(3, true, 1),
                        fan(2, false, 2), ngon(3, 1), fan(5, true, 3)};
  Random random(11);
  std::size_t searched = 0;
  for (int trial = 0; trial < 360; ++trial) {
    SCOPED_TRACE(trial);
    const Cage& cage = cages[random.below(6)];
    const bool is_cut = random.below(3) == 0;
    const LimitSurface surface = limitSurface(cage);
    const SurfaceData map =
        surface.faceVarying(sliverValues(cage, is_cut, trial % 5, random), cornersOf(cage, is_cut),
                            kInterpolations[trial % 6].second);
    const UvMap inverse(map);
    const std::vector<bool> has_area = haveArea(map);
    const std::vector<Location> at = placesOnSides(map.faceCount(), 20, random);
    const DataRows values = map.evaluate(at).value;
    const double extent = extentOf(values);
    // Exactly there, and half of the error that an inversion may leave beside it.
    for (const double off : {0., 0.5e-13}) {
      PlanePoints points = values;
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const double direction = random.uniform(0, kPi2);
        points.row(i) +=
            off * extent * Eigen::RowVector2d(std::cos(direction), std::sin(direction));
      }
      const MapLocations found = inverse.locate(points);
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (!has_area[static_cast<std::size_t>(at[i].face)]) continue;
        ASSERT_GE(found.at[i].face, 0) << describe(at[i]) << ", " << off;
        const DataRows again = map.evaluate({&found.at[i], 1}).value;
        ASSERT_LE((again.row(0) - points.row(static_cast<Eigen::Index>(i))).norm(),
                  2 * kMapError * extent)
            << describe(at[i]);
        ++searched;
      }
    }
  }
  EXPECT_GT(searched, 30'000u);
}

// Triangles as quads: with a corner on the line between its neighbours, or with two equal corners.
// They are one-to-one but there, so that the images of no two places overlap or are mirrored.
TEST(UvSlivers, TrianglesAsQuadsNeitherOverlapNorFlip) {
  Random random(12);
  const Cage cage = grid(1, 1);
  const LimitSurface surface = limitSurface(cage);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const double last = trial % 2 == 0 ? 1 : random.uniform(1.3, 3);
    DataRows of_corners(4, 2);
    of_corners << 0, 0, 1, 0, last, 0, random.uniform(-1, 1), 1;
    const double turn = random.uniform(0, kPi2);
    Eigen::Matrix2d turned;
    turned << std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn);
    of_corners = (of_corners * turned).eval();
    DataRows values(4, 2);
    for (int corner = 0; corner < 4; ++corner) {
      values.row(cage.faces[0][static_cast<std::size_t>(corner)]) = of_corners.row(corner);
    }
    const SurfaceData map = surface.faceVarying(values, cornersOf(cage, false), Interpolation::all);
    const std::vector<Location> at = placesOnSides(1, 100, random);
    const MapLocations found = UvMap(map).locate(PlanePoints(map.evaluate(at).value));
    for (std::size_t i = 0; i < at.size(); ++i) {
      ASSERT_EQ(found.at[i].face, 0) << describe(at[i]);
      ASSERT_FALSE(found.overlap[i]) << describe(at[i]);
      ASSERT_FALSE(found.flipped[i]) << describe(at[i]);
    }
  }
}

// A straight border that runs through the centres of a row of texels, up to a corner where it folds
// back onto itself.
TEST(UvSlivers, RasterHasTheTexelsOfABorderThroughTheirCentres) {
  constexpr int kWidth = 16384, kHeight = 5;
  Cage cage;
  cage.positions.resize(6, 3);
  cage.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 1, 1, 0, -1, 1, 0;
  cage.faces = {{0, 1, 4, 2}, {0, 2, 5, 3}};
  DataRows values(6, 2);
  values << 0, 0, 1, 0.9, 0.9, 1, -0.9, 1, 1, 1, -1, 1;
  values.col(0) = (0.5 + 0.5 * (values.col(0).array() + 1) * (kWidth - 1)) / kWidth;
  values.col(1) = (0.5 + values.col(1).array() * (kHeight - 1)) / kHeight;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceData map =
      surface.faceVarying(values, cornersOf(cage, false), Interpolation::corners_only);
  const Texels texels = UvMap(map).rasterize(image(kWidth, kHeight));
  int on_border = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) on_border += texels.y[i] == kHeight - 1;
  EXPECT_EQ(on_border, kWidth);
}

}  // namespace
}  // namespace limitsurf::test
