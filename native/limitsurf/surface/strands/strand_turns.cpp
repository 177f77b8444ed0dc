// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_turns.h"

#include <Eigen/Geometry>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/interruption_point.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/strands/strand_offsets.h"

namespace limitsurf {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kNearlyOpposite = 1e-9;

/// NaN for vectors without a direction.
Vector3 unit(const Vector3& vector) {
  const double length = vector.stableNorm();
  if (!(length > 0)) {
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return vector / length;
}

Matrix mirror(const Vector3& normal) {
  return Matrix::Identity() - 2 * normal * normal.transpose();
}

Vector3 leastAlignedAxis(const Vector3& vector) {
  Eigen::Index axis;
  vector.cwiseAbs().minCoeff(&axis);
  return Vector3::Unit(axis);
}

}  // namespace

// Two reflections: one reverses the vector, the other exchanges that for the other vector.
Eigen::Matrix3d shortestTurn(const Vector3& from, const Vector3& to) {
  if (!from.allFinite()) {
    return Eigen::Matrix3d::Identity();
  }
  const Vector3 source = unit(from), target = unit(to);
  Vector3 between = source + target;
  if (between.norm() < kNearlyOpposite) {
    between = source.cross(leastAlignedAxis(source));
  }
  return mirror(unit(between)) * mirror(source);
}

Rotations shortestTurns(const Points& from, const Points& to) {
  checkRows("target", to.rows(), from.rows(), "source");
  Rotations turns(from.rows(), 9);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < from.rows(); ++row) {
    stride.step();
    Eigen::Map<Matrix>(turns.row(row).data()) = shortestTurn(from.row(row), to.row(row));
  }
  return turns;
}

Rotations rotationsOf(const Quaternions& quaternions) {
  Rotations rotations(quaternions.rows(), 9);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < quaternions.rows(); ++row) {
    stride.step();
    // By their largest number first: the length of very long ones is infinite, and that of very
    // short ones has few digits.
    const Eigen::RowVector4d given = quaternions.row(row);
    const Eigen::RowVector4d q = (given / given.cwiseAbs().maxCoeff()).normalized();
    Eigen::Map<Matrix>(rotations.row(row).data()) =
        Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }
  return rotations;
}

Points movedStrands(const Points& points, const std::vector<std::int64_t>& offsets,
                    const Points& from, const Points& to, const Rotations& turns) {
  const Eigen::Index strands = turns.rows();
  checkRows("roots", from.rows(), strands, "turns");
  checkRows("new_roots", to.rows(), strands, "turns");
  if (!offsets.empty()) {
    checkOffsets(offsets, static_cast<std::size_t>(strands));
  }
  checkRows("points", points.rows(), offsets.empty() ? strands : offsets.back(),
            offsets.empty() ? "turns" : nullptr);
  Points moved(points.rows(), 3);
  InterruptionStride stride;
  for (Eigen::Index strand = 0; strand < strands; ++strand) {
    stride.step();
    const auto i = static_cast<std::size_t>(strand);
    const Eigen::Index begin = offsets.empty() ? strand : offsets[i],
                       end = offsets.empty() ? strand + 1 : offsets[i + 1];
    const Eigen::Map<const Matrix> turn(turns.row(strand).data());
    const Vector3 root = from.row(strand), new_root = to.row(strand);
    for (Eigen::Index point = begin; point < end; ++point) {
      const Vector3 arm = points.row(point).transpose() - root;
      moved.row(point) = (new_root + turn * arm).transpose();
    }
  }
  return moved;
}

}  // namespace limitsurf
