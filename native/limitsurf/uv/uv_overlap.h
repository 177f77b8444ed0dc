// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/uv/uv_inverse.h"

namespace limitsurf {

/// A find on the border of its cell around which the cell's image is known.
struct BorderFind {
  std::int64_t point;
  int wedge_count;
  Wedge wedges[2];
};

/// Tells whether the images of cells around a point overlap.
class WedgeOverlap {
 public:
  /// The wedges of each find give the image of its cell; the images of neighbouring cells only
  /// touch. Cost: O(n log n) for n finds.
  bool of(const BorderFind* begin, const BorderFind* end);

 private:
  /// The angles between which a wedge of a find lies.
  struct Arc {
    double begin, end;
    const BorderFind* find;
  };
  void add(const BorderFind& find);

  std::vector<Arc> arcs_;  // kept so that not every point needs an allocation
};

}  // namespace limitsurf
