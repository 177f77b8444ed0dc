// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/eigen/eigenbasis.h"

namespace limitsurf {

/// For 0 to `steps` steps of a ring, a bound on the largest distance of its points from its limit,
/// as a part of that distance before these steps.
///
/// A step multiplies the points' vector by S (Lacewell & Burley 2007, section 2). Relative to the
/// limit it also multiplies it by S - 1 w, w the weights of the points on the limit, since w of
/// such a vector is 0. The bound is the norm of (S - 1 w)^n that belongs to maxima: the largest sum
/// of absolute values of a row. Cost: O(steps faces^2).
std::vector<double> ringShrinkage(const Eigenbasis& basis, int steps);

}  // namespace limitsurf
