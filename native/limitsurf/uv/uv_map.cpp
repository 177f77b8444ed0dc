// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_map.h"

#include <mutex>

#include "limitsurf/parallel.h"
#include "limitsurf/uv/uv_raster.h"
#include "limitsurf/uv/uv_search.h"

namespace limitsurf {

struct UvMap::Data {
  Data(const SurfaceData& map, int threads) : patches(map, threads), search(patches) {}

  const UvBorders& borders(int threads) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!borders_) {
      borders_ = std::make_unique<UvBorders>(patches, threads);
    }
    return *borders_;
  }

  UvPatches patches;
  UvSearch search;

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<UvBorders> borders_;  // made for the first margin
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
