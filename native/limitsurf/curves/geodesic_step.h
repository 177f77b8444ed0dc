// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A place on a bicubic patch and a direction there.
struct GeodesicState {
  double s = 0, t = 0;
  Vector3 direction = Vector3::Zero();  ///< unit, in the tangent plane
};

/// The tangent plane of a patch at a place.
struct PatchTangents {
  Vector3 position, ds, dt;

  PatchTangents(const BezierPatch& patch, double s, double t);

  /// Unit, or 0 where ds and dt are parallel.
  Vector3 normal() const;
};

/// How the state changes with the length, by the geodesic equation: (s, t) moves in the direction,
/// which turns with the surface alone.
struct GeodesicRate {
  double s = 0, t = 0;
  Vector3 direction = Vector3::Zero();
  bool exists = true;  ///< false where ds and dt are parallel
};
GeodesicRate geodesicRate(const BezierPatch& patch, const GeodesicState& at);

/// A step of length h by the method of Dormand & Prince, of order 5.
struct GeodesicStep {
  GeodesicState to;
  double error = 0;  ///< estimate of the error of the place in space and of the direction
  bool exists = true;
};
GeodesicStep geodesicStep(const BezierPatch& patch, const GeodesicState& from, double h);

}  // namespace limitsurf
