// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/project/box_projectors.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

#include "limitsurf/direction_maps.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/number_text.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/search/checks.h"

namespace limitsurf {

std::array<Eigen::Matrix4d, 6> boxSides(const Eigen::Matrix4d& matrix) {
  invertibleLinearPart(matrix, "matrix");
  std::array<Eigen::Matrix4d, 6> sides;
  for (int side = 0; side < 6; ++side) {
    const Vector3 outward = (side % 2 == 0 ? 1 : -1) * Vector3::Unit(side / 2);
    const Vector3 up = side / 2 == 2 ? Vector3::UnitY() : Vector3::UnitZ();
    Eigen::Matrix4d projector = Eigen::Matrix4d::Identity();
    projector.row(0).head<3>() = up.cross(outward);
    projector.row(1).head<3>() = up;
    projector.row(2).head<3>() = -outward;
    sides[static_cast<std::size_t>(side)] = projector * matrix;
  }
  return sides;
}

BoxWeights boxWeights(const Points& normals, double blend, const Eigen::Matrix4d& matrix) {
  if (!(blend >= 0 && blend <= 1)) {
    throw std::invalid_argument("blend is " + numberText(blend) + "; expected 0 to 1");
  }
  const Eigen::Matrix3d to_box = DirectionMaps(invertibleLinearPart(matrix, "matrix")).normals;
  checkDirections(normals, "normals");
  BoxWeights weights = BoxWeights::Zero(normals.rows(), 6);
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    stride.step();
    const Vector3 normal = to_box * normals.row(row).transpose().stableNormalized();
    Eigen::Index largest;
    const double most = normal.cwiseAbs().maxCoeff(&largest);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double above = std::abs(normal[axis]) / most - (1 - blend);
      const double weight = blend > 0 ? std::max(0., above) : axis == largest ? 1. : 0.;
      weights(row, 2 * axis + (normal[axis] < 0 ? 1 : 0)) = weight;
    }
    weights.row(row) /= weights.row(row).sum();
  }
  return weights;
}

}  // namespace limitsurf
