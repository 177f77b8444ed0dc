// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limitsurf {

/// Places in an image, one (s, t) a row: (0, 0) is its lower left corner, (1, 1) its upper right
/// one.
using ImagePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// What a texel sees of an image, to first order: a row holds ds/dx, ds/dy, dt/dx, dt/dy, by how
/// much (s, t) moves from texel to texel along x and along y.
using Footprints = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// Longer footprints make no difference: four times the image is its mean.
constexpr double kLongestFootprint = 4;

}  // namespace limitsurf
