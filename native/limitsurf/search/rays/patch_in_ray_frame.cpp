// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/patch_in_ray_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace limitsurf {
namespace {

/// Limits of iterations that converge in a few steps except on degenerate patches; chosen, not
/// derived. The iteration along a side always takes kSideSteps steps.
constexpr int kMostCrossSteps = 24, kMostApproachSteps = 40, kMostPointSteps = 24, kSideSteps = 6;
/// A Newton step this short leaves an error of its square.
constexpr double kLastStep = 1e-8;
/// Damping of the Levenberg-Marquardt iteration, relative to the trace of the matrix: at first, its
/// limits, and the factor by which it changes.
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-12, kMostDamping = 1e8, kDampingStep = 8;

/// The cubic Bernstein polynomials, and the quadratic ones times 3: the weights of the derivative.
void bernstein(double t, double value[4], double first[3]) {
  const double s = 1 - t;
  value[0] = s * s * s;
  value[1] = 3 * s * s * t;
  value[2] = 3 * s * t * t;
  value[3] = t * t * t;
  first[0] = 3 * s * s;
  first[1] = 6 * s * t;
  first[2] = 3 * t * t;
}

/// Newton's step. Where it leads out of the cell, the other parameter is solved for on the side
/// that the step crosses.
void step(const PatchInRayFrame::Aside& f, const ParameterSquare& cell, double s, double t,
          double& next_s, double& next_t) {
  const double determinant = f.xs * f.yt - f.xt * f.ys;
  const double s1 = cell.s + cell.size, t1 = cell.t + cell.size;
  next_s = s - (f.yt * f.x - f.xt * f.y) / determinant;
  next_t = t - (f.xs * f.y - f.ys * f.x) / determinant;
  const double beyond_s = std::max(cell.s - next_s, next_s - s1),
               beyond_t = std::max(cell.t - next_t, next_t - t1);
  if (beyond_s > 0 && beyond_s >= beyond_t) {
    next_s = std::clamp(next_s, cell.s, s1);
    const double x = f.x + f.xs * (next_s - s), y = f.y + f.ys * (next_s - s);
    next_t = t - (x * f.xt + y * f.yt) / (f.xt * f.xt + f.yt * f.yt);
  } else if (beyond_t > 0) {
    next_t = std::clamp(next_t, cell.t, t1);
    const double x = f.x + f.xt * (next_t - t), y = f.y + f.yt * (next_t - t);
    next_s = s - (x * f.xs + y * f.ys) / (f.xs * f.xs + f.ys * f.ys);
  }
  next_s = std::clamp(next_s, cell.s, s1);
  next_t = std::clamp(next_t, cell.t, t1);
}

}  // namespace

RayFrame::RayFrame(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
  int least;
  direction.cwiseAbs().minCoeff(&least);
  across[0] = direction.cross(Vector3::Unit(least)).normalized();
  across[1] = direction.cross(across[0]);
}

PatchInRayFrame::PatchInRayFrame(const BezierPatch& patch, const RayFrame& ray) {
  const Vector3 offset = patch.anchor.head<3>().matrix() - ray.origin;
  const double x0 = offset.dot(ray.across[0]), y0 = offset.dot(ray.across[1]),
               z0 = offset.dot(ray.direction);
  for (int i = 0; i < 16; ++i) {
    const Vector3 point = patch.points[i].head<3>();
    x.at(i & 3, i >> 2) = x0 + point.dot(ray.across[0]);
    y.at(i & 3, i >> 2) = y0 + point.dot(ray.across[1]);
    z.at(i & 3, i >> 2) = z0 + point.dot(ray.direction);
  }
}

PatchInRayFrame::Aside PatchInRayFrame::aside(double s, double t) const {
  double vs[4], ds[3], vt[4], dt[3];
  bernstein(s, vs, ds);
  bernstein(t, vt, dt);
  Aside seen{};
  double rows_x[4], rows_y[4];
  for (int j = 0; j < 4; ++j) {
    const double *px = x.row(j), *py = y.row(j);
    rows_x[j] = vs[0] * px[0] + vs[1] * px[1] + vs[2] * px[2] + vs[3] * px[3];
    rows_y[j] = vs[0] * py[0] + vs[1] * py[1] + vs[2] * py[2] + vs[3] * py[3];
    seen.xs +=
        vt[j] * (ds[0] * (px[1] - px[0]) + ds[1] * (px[2] - px[1]) + ds[2] * (px[3] - px[2]));
    seen.ys +=
        vt[j] * (ds[0] * (py[1] - py[0]) + ds[1] * (py[2] - py[1]) + ds[2] * (py[3] - py[2]));
    seen.x += vt[j] * rows_x[j];
    seen.y += vt[j] * rows_y[j];
  }
  for (int j = 0; j < 3; ++j) {
    seen.xt += dt[j] * (rows_x[j + 1] - rows_x[j]);
    seen.yt += dt[j] * (rows_y[j + 1] - rows_y[j]);
  }
  return seen;
}

double PatchInRayFrame::along(double s, double t) const {
  double vs[4], vt[4], unused[3];
  bernstein(s, vs, unused);
  bernstein(t, vt, unused);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const double* row = z.row(j);
    sum += vt[j] * (vs[0] * row[0] + vs[1] * row[1] + vs[2] * row[2] + vs[3] * row[3]);
  }
  return sum;
}

PatchInRayFrame::Along PatchInRayFrame::alongWithDerivatives(double s, double t) const {
  double vs[4], ds[3], vt[4], dt[3];
  bernstein(s, vs, ds);
  bernstein(t, vt, dt);
  Along seen{};
  double rows[4];
  for (int j = 0; j < 4; ++j) {
    const double* p = z.row(j);
    rows[j] = vs[0] * p[0] + vs[1] * p[1] + vs[2] * p[2] + vs[3] * p[3];
    seen.zs += vt[j] * (ds[0] * (p[1] - p[0]) + ds[1] * (p[2] - p[1]) + ds[2] * (p[3] - p[2]));
    seen.z += vt[j] * rows[j];
  }
  for (int j = 0; j < 3; ++j) {
    seen.zt += dt[j] * (rows[j + 1] - rows[j]);
  }
  return seen;
}

bool PatchInRayFrame::cross(const ParameterSquare& cell, double tolerance, double& s,
                            double& t) const {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostCrossSteps; ++i) {
    const Aside f = aside(s, t);
    const double residual = f.squared();
    double next_s, next_t;
    step(f, cell, s, t, next_s, next_t);
    const bool close = residual <= tolerance * tolerance;
    if (!(std::isfinite(next_s) && std::isfinite(next_t)) || (close && residual >= before)) {
      return close;
    }
    const bool last = std::abs(next_s - s) + std::abs(next_t - t) < kLastStep;
    s = next_s;
    t = next_t;
    before = residual;
    if (last) {
      return aside(s, t).squared() <= tolerance * tolerance;
    }
  }
  return false;
}

bool PatchInRayFrame::approach(const ParameterSquare& cell, double tolerance, double& s,
                               double& t) const {
  const double enough = tolerance * tolerance;
  double damping = kFirstDamping;
  Aside f = aside(s, t);
  double residual = f.squared();
  for (int i = 0; i < kMostApproachSteps && residual > enough; ++i) {
    const double gs = f.x * f.xs + f.y * f.ys, gt = f.x * f.xt + f.y * f.yt;
    const double ss = f.xs * f.xs + f.ys * f.ys, tt = f.xt * f.xt + f.yt * f.yt,
                 st = f.xs * f.xt + f.ys * f.yt;
    const double a = ss + damping * (ss + tt), b = tt + damping * (ss + tt);
    const double determinant = a * b - st * st;
    if (!(determinant > 0)) {
      return false;
    }
    const double next_s =
        std::clamp(s + (st * gt - b * gs) / determinant, cell.s, cell.s + cell.size);
    const double next_t =
        std::clamp(t + (st * gs - a * gt) / determinant, cell.t, cell.t + cell.size);
    const Aside next = aside(next_s, next_t);
    const double next_residual = next.squared();
    if (next_residual < residual) {
      s = next_s;
      t = next_t;
      f = next;
      residual = next_residual;
      damping = std::max(damping / kDampingStep, kLeastDamping);
    } else if (damping > kMostDamping || (next_s == s && next_t == t)) {
      return false;
    } else {
      damping *= kDampingStep;
    }
  }
  return residual <= enough;
}

bool PatchInRayFrame::approachPoint(const ParameterSquare& cell, double place, double tolerance,
                                    double& s, double& t) const {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostPointSteps; ++i) {
    const Aside f = aside(s, t);
    const Along g = alongWithDerivatives(s, t);
    const double ahead = g.z - place, residual = f.squared() + ahead * ahead;
    if (residual <= tolerance * tolerance) {
      return true;
    }
    const double gs = f.x * f.xs + f.y * f.ys + ahead * g.zs,
                 gt = f.x * f.xt + f.y * f.yt + ahead * g.zt;
    const double ss = f.xs * f.xs + f.ys * f.ys + g.zs * g.zs,
                 tt = f.xt * f.xt + f.yt * f.yt + g.zt * g.zt,
                 st = f.xs * f.xt + f.ys * f.yt + g.zs * g.zt;
    const double a = ss + kLeastDamping * (ss + tt), b = tt + kLeastDamping * (ss + tt);
    const double determinant = a * b - st * st;
    if (!(determinant > 0) || !(residual < before)) {
      return false;
    }
    before = residual;
    s = std::clamp(s + (st * gt - b * gs) / determinant, cell.s, cell.s + cell.size);
    t = std::clamp(t + (st * gs - a * gt) / determinant, cell.t, cell.t + cell.size);
  }
  return false;
}

bool PatchInRayFrame::approachSide(const ParameterSquare& cell, int side, double tolerance,
                                   double& s, double& t) const {
  const bool along_s = side < 2;
  const double low = along_s ? cell.s : cell.t, high = low + cell.size;
  s = cell.s + (side == 3 ? cell.size : 0);
  t = cell.t + (side == 1 ? cell.size : 0);
  double& w = along_s ? s : t;
  w = low + cell.size / 2;
  for (int i = 0; i < kSideSteps; ++i) {
    const Aside f = aside(s, t);
    const double dx = along_s ? f.xs : f.xt, dy = along_s ? f.ys : f.yt;
    const double squared = dx * dx + dy * dy;
    if (squared > 0) {
      w = std::clamp(w - (f.x * dx + f.y * dy) / squared, low, high);
    }
  }
  return aside(s, t).squared() <= tolerance * tolerance;
}

}  // namespace limitsurf
