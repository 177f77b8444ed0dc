// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/search/box_tree.h"
#include "limitsurf/uv/uv_map.h"
#include "limitsurf/uv/uv_patches.h"

namespace limitsurf {

/// Searches a map for single points.
class UvSearch {
 public:
  /// Refers to `map`.
  UvSearch(const UvPatches& map, int threads);

  MapLocations locate(const PlanePoints& points, int threads) const;

 private:
  /// Finds all places of a point. `inverse` has a lattice of one point, (0, 0).
  void find(const Point2& point, LatticeInverse& inverse, UvPatches::Sink& finds) const;

  const UvPatches& map_;
  Point2 middle_;
  double scale_;  // a power of two: boxes hold (point - middle) * scale
  std::vector<std::int32_t> order_;
  std::unique_ptr<BoxTree> tree_;
};

}  // namespace limitsurf
