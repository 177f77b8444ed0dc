// SPDX-License-Identifier: Apache-2.0
//
// Rasterised UV maps, compared with a great many evaluated triangles, with closed forms and with
// the evaluation of the map.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "limitsurf/precision/complex.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/throws.h"
#include "support/truth/uv_images.h"

namespace limitsurf::test {
namespace {

/// The diagonal of the box around the values and (0, 0).
double extent(const DataRows& values) {
  const Eigen::RowVector2d low = values.colwise().minCoeff().cwiseMin(0),
                           high = values.colwise().maxCoeff().cwiseMax(0);
  return (high - low).norm();
}

TEST(UvRaster, CoversWhatTheMapCovers) {
  const RasterOptions options = image(48, 40);
  const DataRows points = centres(options);
  std::size_t compared = 0, covered = 0, overlaps = 0, flips = 0;
  for (const NamedMap& named : uvMaps()) {
    SCOPED_TRACE(named.name);
    const UvWitness witness(named.surface, named.map, 16);
    const std::vector<UvWitness::Answer> truth = witness.at(points);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (!truth[i].known) continue;
      const Sheets& sheets = truth[i].sheets;
      ++compared;
      ASSERT_EQ(rows[i] >= 0, sheets.count > 0) << i % 48 << ", " << i / 48;
      if (rows[i] < 0) continue;
      const auto row = static_cast<std::size_t>(rows[i]);
      ++covered;
      ASSERT_EQ(texels.face[row], sheets.lowest_face) << i % 48 << ", " << i / 48;
      ASSERT_EQ(texels.overlap[row] != 0, sheets.count > 1) << i % 48 << ", " << i / 48;
      overlaps += texels.overlap[row];
      if (sheets.of_lowest_face == 1) {
        ASSERT_EQ(texels.flipped[row] != 0, sheets.flipped) << i % 48 << ", " << i / 48;
        flips += texels.flipped[row];
      }
    }
  }
  std::printf("%zu texels compared, %zu covered, %zu overlap, %zu flipped\n", compared, covered,
              overlaps, flips);
  EXPECT_GT(compared, 100000u);
  EXPECT_GT(covered, 30000u);
  EXPECT_GT(overlaps, 2000u);
  EXPECT_GT(flips, 2000u);
}

TEST(UvRaster, LocationsLieUnderTheTexelsCentres) {
  double worst = 0;
  for (const NamedMap& named : uvMaps()) {
    for (const RasterOptions& options : {image(1, 1), image(3, 200), image(150, 90)}) {
      const Texels texels = UvMap(named.map).rasterize(options);
      const DataRows values = valuesAt(named.map, texels);
      for (std::size_t i = 0; i < texels.size(); ++i) {
        const double error =
            (values.row(static_cast<Eigen::Index>(i)) - centre(options, texels.x[i], texels.y[i]))
                .norm();
        worst = std::max(worst, error);
        ASSERT_LE(error, kMapError)
            << named.name << ", texel " << texels.x[i] << ", " << texels.y[i];
        ASSERT_TRUE(texels.inside[i]);
      }
    }
  }
  std::printf("worst error %.2g\n", worst);
}

TEST(UvRaster, IsSortedAndTheSameForAnyNumberOfThreads) {
  const RasterOptions options = image(600, 510, 2);
  const std::vector<NamedMap> maps = uvMaps();
  for (std::size_t i = 0; i < maps.size(); i += 5) {
    const NamedMap& named = maps[i];
    const UvMap map(named.map);
    const Texels texels = map.rasterize(options, 1);
    for (std::size_t k = 1; k < texels.size(); ++k) {
      ASSERT_TRUE(texels.y[k - 1] < texels.y[k] ||
                  (texels.y[k - 1] == texels.y[k] && texels.x[k - 1] < texels.x[k]));
    }
    EXPECT_TRUE(sameBits(texels, UvMap(named.map, 2).rasterize(options, 2))) << named.name;
  }
}

TEST(UvRaster, HasTheSameBitsWithAllInstructionSets) {
  const InstructionSet before = instructionSet();
  const std::vector<NamedMap> maps = uvMaps();
  for (std::size_t i = 1; i < maps.size(); i += 5) {
    // From many texels a face to less than one, so that rows are of all lengths.
    for (const RasterOptions& options : {image(300, 257, 2), image(9, 40)}) {
      const UvMap map(maps[i].map);
      useInstructionSet(InstructionSet::baseline);
      const Texels texels = map.rasterize(options);
      for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
        if (!isAvailable(set)) continue;
        useInstructionSet(set);
        EXPECT_TRUE(sameBits(texels, map.rasterize(options))) << maps[i].name;
      }
    }
  }
  useInstructionSet(before);
}

// The centres of texels lie on every edge and every vertex of the 8 x 8 faces; some coordinates
// have no exact binary representation.
TEST(UvRaster, LosesNothingOnEdgesThroughTexelCentres) {
  for (const Interpolation interpolation : {Interpolation::all, Interpolation::boundaries}) {
    for (const int side : {9, 17, 41, 57}) {
      const auto place = [&](double s, double t) {
        return Eigen::RowVector2d((0.5 + s * (side - 1)) / side, (0.5 + t * (side - 1)) / side);
      };
      const NamedMap named = gridMap(8, 8, interpolation, place);
      const RasterOptions options = image(side, side);
      const Texels texels = UvMap(named.map).rasterize(options);
      ASSERT_EQ(texels.size(), static_cast<std::size_t>(side) * side) << side;
      for (std::size_t i = 0; i < texels.size(); ++i) {
        ASSERT_FALSE(texels.overlap[i]) << side << ": " << texels.x[i] << ", " << texels.y[i];
        ASSERT_FALSE(texels.flipped[i]);
      }
      const DataRows values = valuesAt(named.map, texels);
      for (std::size_t i = 0; i < texels.size(); ++i) {
        ASSERT_LE(
            (values.row(static_cast<Eigen::Index>(i)) - centre(options, texels.x[i], texels.y[i]))
                .norm(),
            kMapError);
      }
    }
  }
}

// Shared edges are curves here, and the centres of texels lie on them up to rounding: an image of
// one texel is moved so that its centre is a point of an edge.
TEST(UvRaster, LosesNothingOnCurvedEdgesAndAtIrregularVertices) {
  const NamedCages cages = {{"fan 3", fan(3, true, 1)},
                            {"fan 5", fan(5, true, 2)},
                            {"fan 8", fan(8, true, 3)},
                            {"grid", perturbed(grid(4, 4), 0.2, 4)}};
  for (const auto& [name, cage] : cages) {
    Random random(5);
    std::vector<std::int64_t> corners;
    for (const auto& face : cage.faces) corners.insert(corners.end(), face.begin(), face.end());
    const LimitSurface surface = limitSurface(cage);
    std::vector<Location> at;
    for (int face = 0; face < surface.faceCount(); ++face) {
      for (int i = 0; i < 12; ++i) {
        const double along = random.uniform();
        at.push_back(i % 2 ? Location{face, 0, along} : Location{face, along, 0});
      }
      at.push_back({face, 0, 0});
      at.push_back({face, 0x1p-30, 0});
      at.push_back({face, 0x1p-45, 0x1p-44});
    }
    const DataRows flat = cage.positions.leftCols(2);
    const SurfaceData map = surface.faceVarying(flat, corners, Interpolation::none);
    const DataRows targets = map.evaluate(at).value;
    PlanePoints points = targets;
    const MapLocations found = UvMap(map).locate(points);
    std::vector<Location> again;
    for (std::size_t i = 0; i < at.size(); ++i) {
      ASSERT_GE(found.at[i].face, 0) << name << " " << describe(at[i]);
      EXPECT_FALSE(found.overlap[i]) << name << " " << describe(at[i]);
      EXPECT_FALSE(found.flipped[i]) << name << " " << describe(at[i]);
      again.push_back(found.at[i]);
    }
    EXPECT_LE((map.evaluate(again).value - targets).rowwise().norm().maxCoeff(),
              kMapError * extent(flat))
        << name;
  }
}

// Two islands that lie on each other overlap everywhere, also along their edges. Two islands beside
// each other, with a common border, do not overlap.
TEST(UvRaster, TellsStackedIslandsFromNeighbours) {
  Cage cage = grid(4, 4);
  const int vertices = cage.vertexCount(), faces = 16;
  std::vector<std::int64_t> corners;
  for (int copy = 0; copy < 2; ++copy) {
    for (int face = 0; face < faces; ++face) {
      for (const int vertex : cage.faces[face]) corners.push_back(vertex + copy * vertices);
    }
  }
  for (int face = 0; face < faces; ++face) {
    std::vector<int> moved = cage.faces[face];
    for (int& vertex : moved) vertex += vertices;
    cage.faces.push_back(moved);
  }
  const Points one = cage.positions;
  cage.positions.resize(2 * vertices, 3);
  cage.positions << one, one;
  const LimitSurface surface = limitSurface(cage);
  const int side = 33;
  for (const bool mirrored : {false, true}) {
    for (const bool stacked : {false, true}) {
      DataRows values(2 * vertices, 2);
      for (int v = 0; v < vertices; ++v) {
        const double s = one(v, 0) / 4, t = one(v, 1) / 4;
        values.row(v) << 0.5 * s, t;
        values.row(v + vertices) << (mirrored ? 0.5 * (1 - s) : 0.5 * s) + (stacked ? 0 : 0.5), t;
      }
      values = (0.5 + values.array() * (side - 1)) / side;
      const SurfaceData map = surface.faceVarying(values, corners, Interpolation::all);
      const Texels texels = UvMap(map).rasterize(image(side, side));
      ASSERT_EQ(texels.size(), static_cast<std::size_t>(side) * (stacked ? side / 2 + 1 : side));
      for (std::size_t i = 0; i < texels.size(); ++i) {
        ASSERT_EQ(texels.overlap[i] != 0, stacked)
            << mirrored << ": " << texels.x[i] << ", " << texels.y[i];
        ASSERT_EQ(texels.flipped[i] != 0, mirrored && texels.face[i] >= faces);
      }
    }
  }
}

// Bilinear quads that fold, inverted in closed form.
TEST(SlowUvRaster, FindsBothSheetsOfFoldedQuads) {
  const double kQuads[][4][2] = {{{0.05, 0.1}, {0.9, 0.2}, {0.4, 0.35}, {0.3, 0.95}},
                                 {{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}, {0.9, 0.9}}};
  constexpr int kSide = 1000;
  long sheets_of_two = 0;
  for (const auto& quad : kQuads) {
    const NamedMap named = gridMap(1, 1, Interpolation::all, [&](double s, double t) {
      const int corner = t == 0 ? (s == 0 ? 0 : 1) : (s == 0 ? 3 : 2);
      return Eigen::RowVector2d(quad[corner][0], quad[corner][1]);
    });
    const RasterOptions options = image(kSide, kSide);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    // Complex numbers as points of the plane.
    const auto point = [&](int i) { return Complex(quad[i][0], quad[i][1]); };
    const Complex a = point(0), b = point(1) - a, c = point(3) - a, d = point(2) - a - b - c;
    const auto area = [](const Complex& x, const Complex& y) {
      return x.real() * y.imag() - x.imag() * y.real();
    };
    long wrong = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Eigen::RowVector2d at = centre(options, x, y);
        const Complex p = Complex(at[0], at[1]) - a;
        // (p - t c) x (b + t d) = 0, a quadratic in t.
        const DoubleDouble c0 = area(p, b), c1 = area(p, d) - area(c, b), c2 = -area(c, d);
        const DoubleDouble discriminant = c1 * c1 - 4 * c2 * c0;
        const bool is_real = discriminant >= 0;
        const DoubleDouble root = is_real ? sqrt(discriminant) : 0;
        int count = 0;
        bool is_close = abs(discriminant) < 1e-12;
        for (const bool first : {true, false}) {
          // The form without cancellation.
          const DoubleDouble q = -(c1 + (c1 < 0 ? -root : root)) / 2;
          const DoubleDouble t = first ? q / c2 : c0 / q;
          const DoubleDouble s = ((p - t * c) / (b + t * d)).real();
          const auto inside = [](const DoubleDouble& v) { return v >= 0 && v <= 1; };
          for (const DoubleDouble& v : {s, t}) {
            is_close |= abs(v) < 1e-9 || abs(v - 1) < 1e-9;
          }
          count += is_real && inside(s) && inside(t);
        }
        if (is_close) continue;
        const int row = rows[y * kSide + x];
        const int found = row < 0 ? 0 : texels.overlap[row] ? 2 : 1;
        wrong += found != count;
        sheets_of_two += count == 2;
      }
    }
    EXPECT_EQ(wrong, 0);
  }
  EXPECT_GT(sheets_of_two, 100);
}

// A sheet that folds back along a slanted line from one side of a wide image to the other.
TEST(UvRaster, FindsBothSheetsAlongLongFolds) {
  constexpr double kHeights[] = {0.1, 0.4, 0.85, 0.6, 0.35, 0.7};
  constexpr double kSlope = 0.07;
  const auto place = [&](double s, double t) {
    return Eigen::RowVector2d(s, kHeights[std::lround(5 * t)] + kSlope * s);
  };
  for (const int columns : {1, 3}) {
    const NamedMap named = gridMap(columns, 5, Interpolation::corners_only, place);
    // The height of one side; the rest of the sheet is the same, translated.
    constexpr int kSamples = 500;
    std::vector<Location> side;
    for (int face = 0; face < 5; ++face) {
      for (int i = 0; i < kSamples; ++i) {
        side.push_back({face * columns, 0, static_cast<double>(i) / kSamples});
      }
    }
    side.push_back({4 * columns, 0, 1});
    const DataRows heights = named.map.evaluate(side).value;
    ASSERT_LE(heights.col(0).cwiseAbs().maxCoeff(), 1e-12);
    const RasterOptions options = image(3000, 200);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    long wrong = 0, compared = 0, folded = 0;
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; x += 29) {
        const Eigen::RowVector2d point = centre(options, x, y);
        const double height = point[1] - kSlope * point[0];
        int count = 0;
        bool is_close = false;
        for (Eigen::Index i = 0; i + 1 < heights.rows(); ++i) {
          count += (heights(i, 1) < height) != (heights(i + 1, 1) < height);
        }
        const int row = rows[y * options.width + x];
        // Close to a fold the samples are not conclusive.
        for (Eigen::Index i = 1; i + 1 < heights.rows(); ++i) {
          is_close |=
              (heights(i, 1) - heights(i - 1, 1)) * (heights(i + 1, 1) - heights(i, 1)) <= 0 &&
              std::abs(heights(i, 1) - height) < 2e-5;
        }
        if (is_close) continue;
        ++compared;
        folded += count > 1;
        wrong +=
            (row >= 0) != (count > 0) || (row >= 0 && (texels.overlap[row] != 0) != (count > 1));
      }
    }
    EXPECT_EQ(wrong, 0) << columns;
    EXPECT_GT(compared, 20000);
    EXPECT_GT(folded, 5000);
  }
}

TEST(SlowUvRaster, TilesAreWindowsOfOneMap) {
  const auto place = [](double s, double t) {
    return Eigen::RowVector2d(-1.3 + 3.1 * s + 0.4 * t, 0.2 + 1.9 * t - 0.3 * s * t);
  };
  const NamedMap named = gridMap(5, 4, Interpolation::none, place);
  const UvMap map(named.map);
  std::size_t count = 0;
  for (int i = -2; i <= 2; ++i) {
    for (int j = -1; j <= 2; ++j) {
      RasterOptions options = image(64, 32);
      options.tile_x = i;
      options.tile_y = j;
      const Texels texels = map.rasterize(options);
      const DataRows values = valuesAt(named.map, texels);
      for (std::size_t t = 0; t < texels.size(); ++t) {
        ASSERT_LE(
            (values.row(static_cast<Eigen::Index>(t)) - centre(options, texels.x[t], texels.y[t]))
                .norm(),
            kMapError * 5);
      }
      count += texels.size();
    }
  }
  // The area of the image in texels, without its borders.
  const UvWitness witness(named.surface, named.map, 48);
  DataRows points(64 * 32 * 20, 2);
  Eigen::Index row = 0;
  for (int y = -32; y < 96; ++y) {
    for (int x = -128; x < 192; ++x) points.row(row++) << (x + 0.5) / 64, (y + 0.5) / 32;
  }
  std::size_t least = 0, most = 0;
  for (const UvWitness::Answer& answer : witness.at(points)) {
    least += answer.known && answer.sheets.count > 0;
    most += !answer.known || answer.sheets.count > 0;
  }
  EXPECT_GE(count, least);
  EXPECT_LE(count, most);
  EXPECT_LT(most - least, 100u);
}

TEST(UvRaster, FacesWithoutAreaCoverNothing) {
  const auto flat = [](double s, double t) { return Eigen::RowVector2d(s + 0.2 * t, 0.5); };
  const auto diagonal = [](double s, double t) {
    return Eigen::RowVector2d(0.7 * s + 0.1 * t, 0.7 * s + 0.1 * t);
  };
  const auto point = [](double, double) { return Eigen::RowVector2d(0.5, 0.5); };
  const auto bent = [](double s, double) { return Eigen::RowVector2d(s, s * s); };
  for (const Interpolation interpolation : {Interpolation::none, Interpolation::all}) {
    for (const int side : {1, 65, 1024}) {
      for (const double margin : {0., 4.}) {
        const RasterOptions options = image(side, side, margin);
        EXPECT_EQ(UvMap(gridMap(6, 6, interpolation, flat).map).rasterize(options).size(), 0u);
        EXPECT_EQ(UvMap(gridMap(6, 6, interpolation, diagonal).map).rasterize(options).size(), 0u);
        EXPECT_EQ(
            UvMap(gridMap(6, 6, Interpolation::corners_only, bent).map).rasterize(options).size(),
            0u);
      }
      // A point is found if it is exactly the centre of a texel, and not otherwise.
      EXPECT_LE(UvMap(gridMap(6, 6, interpolation, point).map).rasterize(image(side, side)).size(),
                1u);
    }
  }
}

TEST(UvRaster, CollapsedEdgesAreCovered) {
  // The lower edge of each column of faces is one point, a texel's centre.
  const auto fan = [](double s, double t) {
    return Eigen::RowVector2d(0.5 + t * (s - 0.5), 0.5 + 0.45 * t);
  };
  for (const Interpolation interpolation : {Interpolation::none, Interpolation::all}) {
    const NamedMap named = gridMap(3, 3, interpolation, fan);
    const RasterOptions options = image(65, 65);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    EXPECT_GT(texels.size(), 300u);
    EXPECT_EQ(rows[31 * 65 + 32], -1);
    for (int y = 33; y < 55; ++y) EXPECT_GE(rows[y * 65 + 32], 0) << y;
    const DataRows values = valuesAt(named.map, texels);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      ASSERT_LE(
          (values.row(static_cast<Eigen::Index>(i)) - centre(options, texels.x[i], texels.y[i]))
              .norm(),
          kMapError);
    }
  }
}

TEST(UvRaster, MapsFarAwayAndHugeOnes) {
  for (const double offset : {10., 1e6, 1e30}) {
    const auto far = [&](double s, double t) { return Eigen::RowVector2d(offset + s, offset + t); };
    EXPECT_EQ(UvMap(gridMap(3, 3, Interpolation::none, far).map).rasterize(image(64, 64)).size(),
              0u);
  }
  for (const double size : {1e3, 1e20, 1e35}) {
    const auto huge = [&](double s, double t) {
      return Eigen::RowVector2d(size * (s - 0.45), size * (t - 0.55));
    };
    const NamedMap named = gridMap(3, 3, Interpolation::none, huge);
    const RasterOptions options = image(64, 64, 2);
    const Texels texels = UvMap(named.map).rasterize(options);
    EXPECT_EQ(texels.size(), 64u * 64u);
    const DataRows values = valuesAt(named.map, texels);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      ASSERT_LE(
          (values.row(static_cast<Eigen::Index>(i)) - centre(options, texels.x[i], texels.y[i]))
              .norm(),
          kMapError * 1.42 * size);
    }
  }
  const auto beyond = [](double s, double t) { return Eigen::RowVector2d(1e40 * s, t); };
  const NamedMap named = gridMap(3, 3, Interpolation::none, beyond);
  expectThrow<std::invalid_argument>([&] { UvMap map(named.map); }, {"e+40", "1e+36"});
}

TEST(UvRaster, OptionsOutOfRangeAreRefused) {
  const auto place = [](double s, double t) { return Eigen::RowVector2d(s, t); };
  const NamedMap named = gridMap(2, 2, Interpolation::none, place);
  const UvMap map(named.map);
  const auto refuse = [&](RasterOptions options, const std::vector<std::string>& parts) {
    expectThrow<std::invalid_argument>([&] { map.rasterize(options); }, parts);
  };
  refuse(image(0, 10), {"width is 0", "65536"});
  refuse(image(10, -5), {"height is -5"});
  refuse(image(65537, 10), {"width is 65537"});
  refuse(image(8, 8, -1), {"margin is -1"});
  refuse(image(8, 8, std::numeric_limits<double>::quiet_NaN()), {"margin is nan"});
  expectThrow<std::invalid_argument>([&] { map.rasterize(image(8, 8), -1); }, {"threads is -1"});
  const DataRows three = DataRows::Zero(9, 3);
  const SurfaceData other = named.surface.vertexData(three);
  expectThrow<std::invalid_argument>([&] { UvMap wrong(other); }, {"3 columns"});
}

}  // namespace
}  // namespace limitsurf::test
