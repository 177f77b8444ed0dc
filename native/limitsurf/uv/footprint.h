// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limitsurf {

/// Places in an image, an (s, t) in each row: (0, 0) is the lower left corner of the image, (1, 1)
/// the upper right one.
using ImagePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// The footprints of texels on an image, to first order. A row holds ds/dx, ds/dy, dt/dx, dt/dy:
/// how far (s, t) moves from texel to texel along x and along y.
using Footprints = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// Longer footprints are shortened to this, in images: the mean over four images does not differ
/// from that over more.
constexpr double kLongestFootprint = 4;

}  // namespace limitsurf
