// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/geodesic_step.h"

#include <Eigen/Geometry>
#include <cmath>

namespace limitsurf {
namespace {

/// The square of the sine of the angle between ds and dt below which they count as parallel.
constexpr double kParallel = 1e-20;

// The coefficients of Dormand & Prince ("A family of embedded Runge-Kutta formulae", 1980).
constexpr int kStages = 7;
constexpr double kA[kStages][kStages - 1] = {
    {},
    {1. / 5},
    {3. / 40, 9. / 40},
    {44. / 45, -56. / 15, 32. / 9},
    {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
    {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
/// Order 5 less order 4.
constexpr double kError[kStages] = {71. / 57600,      0,         -71. / 16695, 71. / 1920,
                                    -17253. / 339200, 22. / 525, -1. / 40};

}  // namespace

PatchTangents::PatchTangents(const BezierPatch& patch, double s, double t) {
  BezierPatch::Values at;
  patch.evaluate<1>(s, t, at);
  position = (patch.anchor + at.value).head<3>().matrix();
  ds = at.ds.head<3>().matrix();
  dt = at.dt.head<3>().matrix();
}

Vector3 PatchTangents::normal() const {
  const Vector3 across = ds.cross(dt);
  const double length = across.norm();
  return length > 0 ? Vector3(across / length) : Vector3(Vector3::Zero());
}

GeodesicRate geodesicRate(const BezierPatch& patch, const GeodesicState& at) {
  BezierPatch::Values values;
  patch.evaluate<2>(at.s, at.t, values);
  const Vector3 ds = values.ds.head<3>().matrix(), dt = values.dt.head<3>().matrix();
  const double e = ds.squaredNorm(), f = ds.dot(dt), g = dt.squaredNorm();
  const double squared = e * g - f * f;  // |ds x dt|^2
  GeodesicRate rate;
  if (!(squared > kParallel * e * g)) {
    rate.exists = false;
    return rate;
  }
  const double along_s = at.direction.dot(ds), along_t = at.direction.dot(dt);
  rate.s = (g * along_s - f * along_t) / squared;
  rate.t = (e * along_t - f * along_s) / squared;
  const Vector3 normal = ds.cross(dt) / std::sqrt(squared);
  const Vector3 second = (rate.s * rate.s * values.dss + 2 * rate.s * rate.t * values.dst +
                          rate.t * rate.t * values.dtt)
                             .head<3>()
                             .matrix();
  rate.direction = normal.dot(second) * normal;
  return rate;
}

GeodesicStep geodesicStep(const BezierPatch& patch, const GeodesicState& from, double h) {
  GeodesicRate rates[kStages];
  GeodesicStep step;
  for (int stage = 0; stage < kStages; ++stage) {
    GeodesicState at = from;
    for (int i = 0; i < stage; ++i) {
      at.s += h * kA[stage][i] * rates[i].s;
      at.t += h * kA[stage][i] * rates[i].t;
      at.direction += h * kA[stage][i] * rates[i].direction;
    }
    if (stage == kStages - 1) {
      step.to = at;
    }
    rates[stage] = geodesicRate(patch, at);
    if (!rates[stage].exists) {
      step.exists = false;
      return step;
    }
  }
  double s = 0, t = 0;
  Vector3 direction = Vector3::Zero();
  for (int i = 0; i < kStages; ++i) {
    s += h * kError[i] * rates[i].s;
    t += h * kError[i] * rates[i].t;
    direction += h * kError[i] * rates[i].direction;
  }
  const PatchTangents end(patch, step.to.s, step.to.t);
  step.error = (s * end.ds + t * end.dt).norm() + std::abs(h) * direction.norm();
  // Rounding and the errors of steps lead out of the tangent plane.
  const Vector3 normal = end.normal();
  const Vector3 flat = step.to.direction - normal.dot(step.to.direction) * normal;
  step.to.direction = flat / flat.norm();
  return step;
}

}  // namespace limitsurf
