// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

/// Evaluates `count` locations of each class of quads, with ours beside Embree's rtcInterpolateN,
/// which works in single precision, and prints the times and how far the results are apart.
/// Returns an exit status.
int measureInterpolation(int count);

}  // namespace limitsurf::bench
