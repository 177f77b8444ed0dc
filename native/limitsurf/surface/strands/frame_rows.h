// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/surface/strands/strand_turns.h"
#include "limitsurf/types.h"

namespace limitsurf {

// What is made of frames, for many things that stand on a surface. A frame is a 3 x 3 matrix in a
// row, row-major, with the columns tangent, normal x tangent, normal, as LimitSurface::frames()
// gives it. All are computed on up to `threads` threads (0: all cores), with the same bits for any
// number of them, and throw std::invalid_argument if numbers of rows differ. Cost: O(rows).

/// One pair of numbers per row.
using Pairs = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Bound on the error of each component of quaternionsOf() and leaning(), for frames that are
/// rotations up to rounding, and of framesInWorld(), where it is multiplied by the condition number
/// of `linear`. Each is a dozen roundings of numbers of size 1: four times the largest component of
/// a unit quaternion is at least 2, so that no digits cancel. leaning() also rounds the length of
/// the angle: the bound is multiplied by 1 + angle / 8.
constexpr double kFrameRowError = 2e-15;

/// Rotations as unit quaternions w, x, y, z with w >= 0; NaN for rows that are not finite.
Quaternions quaternionsOf(const Eigen::Ref<const Rotations>& rotations, int threads = 0);

/// Frames of an object as they are in the world, where `linear` maps the object's vectors: the
/// tangent is mapped, the normal stays perpendicular to the surface, and the column between them is
/// perpendicular to both and points to the side of growing v. So it is left-handed where `linear`
/// mirrors. Columns are unit vectors, NaN where they have no direction.
Rotations framesInWorld(const Eigen::Ref<const Rotations>& frames, const Eigen::Matrix3d& linear,
                        int threads = 0);

/// Unit vectors: the last column of each frame, turned towards the first two columns by the two
/// angles (in radians) of its row. Both are one turn, about one axis.
Points leaning(const Eigen::Ref<const Rotations>& frames, const Eigen::Ref<const Pairs>& angles,
               int threads = 0);

/// Straight strands of so many points, evenly spaced from each root to root + along, one strand
/// after the other, rounded to float. A strand of one point is its root. Throws
/// std::invalid_argument for points below 1.
FloatPoints straightStrands(const Eigen::Ref<const Points>& roots,
                            const Eigen::Ref<const Points>& along, int points, int threads = 0);
/// The same, written to the caller's memory, which has room for all points.
void straightStrands(const Eigen::Ref<const Points>& roots, const Eigen::Ref<const Points>& along,
                     int points, Eigen::Map<FloatPoints> strands, int threads = 0);

}  // namespace limitsurf
