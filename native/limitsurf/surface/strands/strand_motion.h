// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/pose/padded.h"
#include "limitsurf/surface/strands/root_pose.h"

namespace limitsurf {

/// A vector of three plain numbers: Padded vectors that are made of single numbers have to pass
/// through memory, which takes twice the time.
struct Triple {
  double x, y, z;

  Triple(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit Triple(const Padded& v) : x(v[0]), y(v[1]), z(v[2]) {}
  explicit Triple(const float* p) : x(p[0]), y(p[1]), z(p[2]) {}

  Triple operator+(const Triple& other) const { return {x + other.x, y + other.y, z + other.z}; }
  Triple operator-(const Triple& other) const { return {x - other.x, y - other.y, z - other.z}; }
  void store(float* to) const {
    to[0] = static_cast<float>(x);
    to[1] = static_cast<float>(y);
    to[2] = static_cast<float>(z);
  }
};

inline Triple operator*(double factor, const Triple& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}

/// A rigid motion: p goes to `to` + turn (p - from).
struct Motion {
  Triple turn[3];  // the columns
  Triple from, to;

  Triple turned(const Triple& v) const { return v.x * turn[0] + v.y * turn[1] + v.z * turn[2]; }
  void move(const float* point, float* out) const {
    (to + turned(Triple(point) - from)).store(out);
  }
  Motion inverse() const {
    return {{{turn[0].x, turn[1].x, turn[2].x},
             {turn[0].y, turn[1].y, turn[2].y},
             {turn[0].z, turn[1].z, turn[2].z}},
            to,
            from};
  }
};

/// The motion from the rest root, where the frame was the rotation by the quaternion
/// `rest_rotation` of any length, to the root as it is posed.
inline Motion motionOf(const float* rest_root, const float* rest_rotation, const RootPose& root) {
  const double w = rest_rotation[0], x = rest_rotation[1], y = rest_rotation[2],
               z = rest_rotation[3], twice = 2 / (w * w + x * x + y * y + z * z);
  const double rest[3][3] = {
      {1 - twice * (y * y + z * z), twice * (x * y - w * z), twice * (x * z + w * y)},
      {twice * (x * y + w * z), 1 - twice * (x * x + z * z), twice * (y * z - w * x)},
      {twice * (x * z - w * y), twice * (y * z + w * x), 1 - twice * (x * x + y * y)}};
  const auto column = [&](int i) {
    return rest[i][0] * Triple(root.frame[0]) + rest[i][1] * Triple(root.frame[1]) +
           rest[i][2] * Triple(root.frame[2]);
  };
  return {{column(0), column(1), column(2)}, Triple(rest_root), Triple(root.position)};
}

}  // namespace limitsurf
