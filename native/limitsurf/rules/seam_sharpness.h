// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <vector>

namespace limitsurf {

/// A vertex that is pinned for some steps and no longer. In the last of them its new point has this
/// share of the old one.
struct LastingCorner {
  int steps = 0;
  float last_share = 0;

  bool lasts() const { return steps > 1; }
  /// A finite sharpness with the same effect on the next step.
  float sharpness() const {
    return lasts() ? std::min(static_cast<float>(steps), 9.f) : last_share;
  }
  LastingCorner next() const { return {steps - 1, last_share}; }
};

/// What the sharpness beyond the seams of a face-varying channel does to vertices of the channel's
/// own mesh, in which a seam is a boundary and nothing lies beyond it.
struct SeamSharpness {
  /// The semi-sharp edges at a vertex that are seams, or lie beyond one. They count in the average
  /// of Chaikin's rule alone.
  std::map<int, std::vector<float>> averaged_edges;
  /// Vertices that are corners for as long as edges beyond a seam are sharp.
  std::map<int, LastingCorner> corners;
};

}  // namespace limitsurf
