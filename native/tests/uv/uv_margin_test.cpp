// SPDX-License-Identifier: Apache-2.0
//
// The margins of rasterised UV maps, compared with the nearest of a great many points of the map.
#include <gtest/gtest.h>

#include <cstdio>

#include "support/truth/uv_images.h"

namespace limitsurf::test {
namespace {

TEST(UvMargin, HoldsTheNearestPlaces) {
  const RasterOptions options = image(48, 40, 5);
  const Eigen::RowVector2d scale(options.width, options.height);
  std::size_t compared = 0;
  double worst = 0;
  for (const NamedMap& named : uvMaps()) {
    if (named.name.find("random") != std::string::npos) continue;
    SCOPED_TRACE(named.name);
    const UvWitness witness(named.surface, named.map, 48);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    const DataRows values = valuesAt(named.map, texels);
    for (int y = 0; y < options.height; y += 1) {
      for (int x = (y * 7) % 5; x < options.width; x += 5) {
        const int row = rows[y * options.width + x];
        if (row >= 0 && texels.inside[row]) continue;
        const Eigen::RowVector2d point = centre(options, x, y);
        const double nearest = witness.distance(point, scale);
        if (row < 0) {
          ASSERT_GT(nearest, options.margin - kMarginError) << x << ", " << y;
          continue;
        }
        const double found = ((values.row(row) - point).array() * scale.array()).matrix().norm();
        ASSERT_LE(found, options.margin + 1e-9);
        worst = std::max(worst, found - nearest);
        ASSERT_LE(found, nearest + kMarginError) << x << ", " << y;
        ASSERT_FALSE(texels.overlap[row]);
        ++compared;
      }
    }
  }
  std::printf("%zu texels of margins, at most %.2g texels farther than the nearest sample\n",
              compared, worst);
  EXPECT_GT(compared, 3000u);
}

TEST(UvMargin, OfFoldedMapsComesClose) {
  const RasterOptions options = image(40, 40, 4);
  const Eigen::RowVector2d scale(options.width, options.height);
  for (const NamedMap& named : uvMaps()) {
    if (named.name.find("random") == std::string::npos) continue;
    SCOPED_TRACE(named.name);
    const UvWitness witness(named.surface, named.map, 32);
    const Texels texels = UvMap(named.map).rasterize(options);
    const std::vector<int> rows = rowsOf(texels, options);
    const DataRows values = valuesAt(named.map, texels);
    for (int i = 3; i < 40 * 40; i += 11) {
      const int row = rows[i];
      if (row >= 0 && texels.inside[row]) continue;
      const Eigen::RowVector2d point = centre(options, i % 40, i / 40);
      const double nearest = witness.distance(point, scale);
      if (row < 0) {
        ASSERT_GT(nearest, options.margin - 0.5);
      } else {
        ASSERT_LE(((values.row(row) - point).array() * scale.array()).matrix().norm(),
                  nearest + 0.5);
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
