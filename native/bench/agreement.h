// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bfr_peer.h"
#include "face_classes.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::bench {

/// A larger difference between the two libraries means that one of them was timed computing
/// something else. Positions: relative to the cage's diagonal; derivatives: to the largest. Bfr's
/// second derivatives lose up to 4^8 * 1e-16 * diagonal by cancellation.
constexpr double kAgreement = 1e-7;

/// Largest difference between LimitSurface and Bfr level 10, over position and all derivatives, at
/// locations farther than 2^-8 from the corners of faces: Bfr approximates nearer to EVs.
double largestDifference(const Cage& cage, const LimitSurface& ours, const BfrPeer& bfr,
                         Span<Location> at);

/// Prints the difference and remembers whether any was above kAgreement.
void noteDifference(const std::string& what, double difference);
bool allAgreed();

}  // namespace limitsurf::bench
