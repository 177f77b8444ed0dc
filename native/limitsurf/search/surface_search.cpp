// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/surface_search.h"

#include "limitsurf/search/checks.h"
#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {
SurfaceSearch::SurfaceSearch(const LimitSurface& surface, int threads)
    : data_(std::make_unique<SearchTree>(surface, threads)) {}
SurfaceSearch::~SurfaceSearch() = default;
SurfaceSearch::SurfaceSearch(SurfaceSearch&&) noexcept = default;
SurfaceSearch& SurfaceSearch::operator=(SurfaceSearch&&) noexcept = default;

double SurfaceSearch::farthestOrigin() const { return kFarthestPoint / data_->scale; }

}  // namespace limitsurf
