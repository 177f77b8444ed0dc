// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_map.h"

#include "limitsurf/first_made.h"
#include "limitsurf/parallel.h"
#include "limitsurf/uv/uv_raster.h"
#include "limitsurf/uv/uv_search.h"

namespace limitsurf {

struct UvMap::Data {
  Data(const SurfaceData& map, int threads) : patches(map, threads), search(patches, threads) {}

  const UvBorders& borders(int threads) const {
    return borders_.get([&] { return std::make_unique<const UvBorders>(patches, threads); });
  }

  UvPatches patches;
  UvSearch search;

 private:
  FirstMade<UvBorders> borders_;  // made for the first margin
};

UvMap::UvMap(const SurfaceData& map, int threads)
    : data_((checkThreads(threads), std::make_unique<Data>(map, threads))) {}
UvMap::~UvMap() = default;
UvMap::UvMap(UvMap&&) noexcept = default;
UvMap& UvMap::operator=(UvMap&&) noexcept = default;

Texels UvMap::rasterize(const RasterOptions& options, int threads, const Progress& progress) const {
  checkThreads(threads);
  checkOptions(options);
  const auto borders = [&]() -> const UvBorders& { return data_->borders(threads); };
  return limitsurf::rasterize(data_->patches, borders, options, threads, progress);
}

MapLocations UvMap::locate(const PlanePoints& points, int threads) const {
  checkThreads(threads);
  checkPoints(points);
  return data_->search.locate(points, threads);
}

}  // namespace limitsurf
