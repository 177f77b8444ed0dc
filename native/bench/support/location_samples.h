// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/face_classes.h"
#include "limitsurf/types.h"

namespace limitsurf::bench {

/// About `count` random locations, uniform in (u, v), the same number on each face, sorted by face.
std::vector<Location> uniformSamples(const std::vector<int>& faces, int count);

/// Distances 2^-least to 2^-most, with a uniformly random exponent.
struct Distances {
  double least, most;
};

/// The same, but at these distances from the face's EV.
std::vector<Location> samplesNearEvs(const std::vector<ClassifiedFace>& classified,
                                     const std::vector<int>& faces, int count, Distances distances);

/// The same locations in random order.
std::vector<Location> shuffled(std::vector<Location> samples);

/// The location whose coordinates, measured from `corner`, are (s, t): s along the edge to the next
/// corner, t along the edge to the previous one.
Location fromCorner(int face, int corner, double s, double t);

}  // namespace limitsurf::bench
