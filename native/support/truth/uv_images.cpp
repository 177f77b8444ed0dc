// SPDX-License-Identifier: Apache-2.0
#include "support/truth/uv_images.h"

namespace limitsurf::test {

RasterOptions image(int width, int height, double margin) {
  RasterOptions options;
  options.width = width;
  options.height = height;
  options.margin = margin;
  return options;
}

Eigen::RowVector2d centre(const RasterOptions& options, int x, int y) {
  return {options.tile_x + (x + 0.5) / options.width, options.tile_y + (y + 0.5) / options.height};
}

DataRows centres(const RasterOptions& options) {
  DataRows rows(options.width * options.height, 2);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      rows.row(y * options.width + x) = centre(options, x, y);
    }
  }
  return rows;
}

DataRows valuesAt(const SurfaceData& map, const Texels& texels) {
  std::vector<Location> at;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    at.push_back({texels.face[i], texels.uv[i][0], texels.uv[i][1]});
  }
  return map.evaluate(at).value;
}

std::vector<int> rowsOf(const Texels& texels, const RasterOptions& options) {
  std::vector<int> rows(static_cast<std::size_t>(options.width) * options.height, -1);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    rows[static_cast<std::size_t>(texels.y[i]) * options.width + texels.x[i]] = static_cast<int>(i);
  }
  return rows;
}

bool sameBits(const Texels& a, const Texels& b) {
  return a.x == b.x && a.y == b.y && a.face == b.face && a.uv == b.uv && a.inside == b.inside &&
         a.overlap == b.overlap && a.flipped == b.flipped;
}

}  // namespace limitsurf::test
