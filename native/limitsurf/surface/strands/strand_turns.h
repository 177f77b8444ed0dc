// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// One quaternion w, x, y, z per row.
using Quaternions = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// Bound on the error of each entry of shortestTurns(), divided by the length of the sum of the two
/// unit vectors: it grows where they are almost opposite. The largest that was measured is 4.1e-15.
constexpr double kTurnError = 8e-15;

/// The rotation that turns one vector to the direction of another, as shortestTurns() has it.
Eigen::Matrix3d shortestTurn(const Vector3& from, const Vector3& to);

/// The rotations that turn each vector of `from` to the direction of that of `to` by the smallest
/// angle. Vectors may have any length. Where they are opposite (closer than 1e-9 to it) they turn
/// about an axis that is perpendicular to `from`, as near as possible to the world's axis that is
/// least aligned with it. Where `from` is not finite the rotation is the identity, and NaN where
/// another vector has no direction.
///
/// Throws std::invalid_argument if the numbers of rows differ.
Rotations shortestTurns(const Points& from, const Points& to);

/// The rotations of quaternions of any length. They are NaN for a quaternion of zeros.
Rotations rotationsOf(const Quaternions& quaternions);

/// Strands as they are when their roots have moved and the strands have turned with them: a point p
/// of strand i goes to to.row(i) + turn (p - from.row(i)). Strand i has the points offsets[i] to
/// offsets[i + 1] - 1; if `offsets` is empty each strand has one point.
///
/// Throws std::invalid_argument for other numbers of rows, and for offsets that do not begin with
/// 0, decrease, or end with another number than that of the points.
Points movedStrands(const Points& points, const std::vector<std::int64_t>& offsets,
                    const Points& from, const Points& to, const Rotations& turns);

}  // namespace limitsurf
