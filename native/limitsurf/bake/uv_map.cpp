// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/bake/uv_map.h"

#include "limitsurf/bake/uv_locate.h"
#include "limitsurf/bake/uv_raster.h"
#include "limitsurf/parallel.h"

namespace limitsurf {

struct UvMap::Data {
  Data(const SurfaceData& map, int threads) : patches(map, threads), search(patches) {}

  UvPatches patches;
  UvSearch search;
};

UvMap::UvMap(const SurfaceData& map, int threads)
    : data_((checkThreads(threads), std::make_unique<Data>(map, threads))) {}
UvMap::~UvMap() = default;
UvMap::UvMap(UvMap&&) noexcept = default;
UvMap& UvMap::operator=(UvMap&&) noexcept = default;

Texels UvMap::rasterize(const RasterOptions& options, int threads, const Progress& progress) const {
  checkThreads(threads);
  checkOptions(options);
  return limitsurf::rasterize(data_->patches, options, threads, progress);
}

MapLocations UvMap::locate(const PlanePoints& points, int threads) const {
  checkThreads(threads);
  checkPoints(points);
  return data_->search.locate(points, threads);
}

}  // namespace limitsurf
