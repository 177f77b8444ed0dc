// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/shading_frames.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

void checkRows(Eigen::Index rows, const ShadingFrames& frames) {
  for (const Eigen::Index count :
       {frames.normal.rows(), frames.tangent.rows(), frames.sign.rows()}) {
    if (count != rows) {
      throw std::invalid_argument(std::to_string(rows) + " vectors for frames of " +
                                  std::to_string(count) + " rows");
    }
  }
}

/// Columns tangent, bitangent, normal.
Eigen::Matrix3d frameOf(const ShadingFrames& frames, Eigen::Index row) {
  Eigen::Matrix3d frame;
  frame.col(0) = frames.tangent.row(row).transpose();
  frame.col(2) = frames.normal.row(row).transpose();
  frame.col(1) = frames.sign(row) * frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace

Points intoShadingFrames(const Points& directions, const ShadingFrames& frames) {
  checkRows(directions.rows(), frames);
  Points out(directions.rows(), 3);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    stride.step();
    const Eigen::Matrix3d frame = frameOf(frames, row);
    const Vector3 direction = directions.row(row).transpose();
    const double volume = frame.determinant();
    const Vector3 found =
        std::copysign(1.0, volume) * Vector3(frame.col(1).cross(frame.col(2)).dot(direction),
                                             frame.col(2).cross(frame.col(0)).dot(direction),
                                             frame.col(0).cross(frame.col(1)).dot(direction));
    const double length = found.norm();
    out.row(row) = volume != 0 && length > 0 ? Vector3(found / length) : Vector3(Vector3::UnitZ());
  }
  return out;
}

Points outOfShadingFrames(const Points& components, const ShadingFrames& frames) {
  checkRows(components.rows(), frames);
  Points out(components.rows(), 3);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    stride.step();
    const Vector3 found = frameOf(frames, row) * components.row(row).transpose();
    const double length = found.norm();
    out.row(row) = length > 0
                       ? Vector3(found / length)
                       : Vector3(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  return out;
}

}  // namespace limitsurf
