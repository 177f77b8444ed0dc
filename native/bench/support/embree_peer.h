// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "limitsurf/tessellate/tessellation.h"

namespace limitsurf::bench {

/// Embree on the triangles of a tessellation, two for each quad: the closest peer of limitsurf's
/// searches. It works in single precision.
class EmbreePeer {
 public:
  /// The results, a row each; NaN where a ray misses.
  struct Found {
    Points position;
    Eigen::VectorXd distance;
  };

  explicit EmbreePeer(const Tessellation& mesh);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  // Both searches use all cores.

  Found closest(const Points& points) const;
  /// `directions` must have length 1.
  Found rayCast(const Points& origins, const Points& directions) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
  float* vertices_;      ///< three numbers each; Embree owns them
  unsigned* triangles_;  ///< three indices each; Embree owns them
};

}  // namespace limitsurf::bench
