// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/face_classes.h"
#include "limitsurf/types.h"

namespace limitsurf::bench {

/// About `count` random locations, uniform in (u, v), the same number on each face, sorted by face.
std::vector<Location> uniformSamples(const std::vector<int>& faces, int count);

/// The same, but at a distance of 2^-12 to 2^-5 from the face's EV, with a uniformly random
/// exponent.
std::vector<Location> samplesNearEvs(const std::vector<ClassifiedFace>& classified,
                                     const std::vector<int>& faces, int count);

/// The same locations in random order.
std::vector<Location> shuffled(std::vector<Location> samples);

/// The location whose coordinates, measured from `corner`, are (s, t): s along the edge to the next
/// corner, t along the edge to the previous one.
Location fromCorner(int face, int corner, double s, double t);

}  // namespace limitsurf::bench
