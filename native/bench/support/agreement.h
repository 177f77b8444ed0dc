// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/support/bfr_peer.h"
#include "bench/support/face_classes.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::bench {

/// If the two libraries differ by more than this, one of them was timed while computing something
/// else. Differences of positions are relative to the diagonal of the control mesh, those of
/// derivatives to the largest derivative. Bfr's second derivatives lose up to 4^8 * 1e-16 *
/// diagonal by cancellation.
constexpr double kAgreement = 1e-7;

/// The largest difference between LimitSurface and Bfr level 10 in positions and all derivatives,
/// at locations farther than 2^-8 from the corners of faces, since Bfr approximates closer to EVs.
double largestDifference(const MeshArrays& cage, const LimitSurface& ours, const BfrPeer& bfr,
                         Span<Location> at);

/// Prints a difference. allAgreed() tells whether all were below kAgreement.
void noteDifference(const std::string& what, double difference);
bool allAgreed();

}  // namespace limitsurf::bench
