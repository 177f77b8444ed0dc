// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Throws std::invalid_argument naming the first entry that is not finite. `name`: as in "matrix".
void checkFinite(const Eigen::Matrix4d& matrix, const char* name);

/// The linear part of an invertible affine map. Throws std::invalid_argument for a matrix that is
/// singular, not finite or not affine.
Eigen::Matrix3d invertibleLinearPart(const Eigen::Matrix4d& matrix, const char* name);

/// A projector given by a 4 x 4 matrix to clip space, in OpenGL's convention: the image of
/// (x, y, z, w) is (x/w, y/w), from -1 to 1; w is positive in front of the eye, and z/w grows with
/// the distance from it.
class Projector {
 public:
  /// Throws std::invalid_argument for a matrix that is not finite, or so singular that points have
  /// no unique line of sight. The size and the place of `surface` decide what is negligible.
  Projector(const Eigen::Matrix4d& matrix, const LimitSurface& surface);

  /// The image of a point.
  struct View {
    bool in_front;
    Eigen::Vector2d st;  ///< in image coordinates: [0, 1] x [0, 1] is the frame
    Eigen::Matrix<double, 2, 3> st_by_point;  ///< first derivatives of st
    double depth;                             ///< z/w
    Vector3 to_eye;                           ///< unit vector
  };
  View see(const Vector3& point) const;

  /// The distance from a point to the eye, infinite for parallel projection; and the distance, in
  /// the direction of the eye, to the plane z/w = near, infinite if that does not lie there.
  double distanceToEye(const Vector3& point) const;
  double distanceToPlane(const Vector3& point, const Vector3& to_eye, double near) const;

  bool hasEye() const { return has_eye_; }
  const Vector3& eye() const { return eye_; }

 private:
  /// Times a number, which changes no image: its last row is in a unit of its own, so that the
  /// images of points neither overflow nor vanish.
  Eigen::Matrix4d matrix_;
  bool has_eye_;
  Vector3 eye_;        ///< if has_eye_
  Vector3 backwards_;  ///< the direction towards the eye at infinity otherwise
};

}  // namespace limitsurf
