// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Throws std::invalid_argument naming the first entry that is not finite. `name`: as in "matrix".
void checkFinite(const Eigen::Matrix4d& matrix, const char* name);

/// The linear part of an affine map that can be undone; std::invalid_argument for one that cannot,
/// is not finite, or is not affine.
Eigen::Matrix3d invertibleLinearPart(const Eigen::Matrix4d& matrix, const char* name);

/// What a 4 x 4 matrix to clip space, as OpenGL has it, says about points: the image of (x, y, z,
/// w) is x/w and y/w, from -1 to 1; w is above 0 in front of the eye, and z/w grows away from it.
class Projector {
 public:
  /// Throws std::invalid_argument for a matrix that is not finite, or so singular that it has no
  /// one line of sight for each point; `surface` decides what counts as small.
  Projector(const Eigen::Matrix4d& matrix, const LimitSurface& surface);

  /// A point as the projector sees it.
  struct View {
    bool in_front;
    Eigen::Vector2d st;                       ///< the frame is [0, 1] x [0, 1]
    Eigen::Matrix<double, 2, 3> st_by_point;  ///< first derivatives
    double depth;                             ///< z/w
    Vector3 to_eye;                           ///< unit vector
  };
  View see(const Vector3& point) const;

  /// How far from a point in front of it the eye is, infinite for parallel projection; or how far
  /// the surface z/w = near, if there is one.
  double distanceToEye(const Vector3& point) const;
  double distanceToPlane(const Vector3& point, const Vector3& to_eye, double near) const;

  bool hasEye() const { return has_eye_; }
  const Vector3& eye() const { return eye_; }

 private:
  Eigen::Matrix4d matrix_;
  bool has_eye_;
  Vector3 eye_;        ///< where there is one
  Vector3 backwards_;  ///< else
};

}  // namespace limitsurf
