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

/// Newton's step. Where it leads out of the cell, the other parameter is solved for on the side
/// that the step crosses.
void step(const OffsetFromRay& f, const ParameterRectangle& cell, double s, double t,
          double& next_s, double& next_t) {
  const double determinant = f.xs * f.yt - f.xt * f.ys;
  const double s1 = cell.s + cell.s_size, t1 = cell.t + cell.t_size;
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

PatchInRayFrame::PatchInRayFrame(const BezierPatch& patch, const RayFrame& ray)
    : kernels_(&RayKernels::get()) {
  const Vector3 from_origin = patch.anchor.head<3>().matrix() - ray.origin;
  const Vector3* const axes[3] = {&ray.across[0], &ray.across[1], &ray.direction};
  double offset[3], directions[3][4];
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = from_origin.dot(*axes[axis]);
    std::copy_n(axes[axis]->data(), 3, directions[axis]);
    directions[axis][3] = 0;
  }
  kernels_->see(numbersOf(patch.points), directions, offset, x.data(), y.data(), z.data());
}

bool PatchInRayFrame::cross(const ParameterRectangle& cell, double tolerance, double& s,
                            double& t) const {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostCrossSteps; ++i) {
    const OffsetFromRay f = offset(s, t);
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
      return offset(s, t).squared() <= tolerance * tolerance;
    }
  }
  return false;
}

bool PatchInRayFrame::approach(const ParameterRectangle& cell, double tolerance, double& s,
                               double& t) const {
  const double enough = tolerance * tolerance;
  double damping = kFirstDamping;
  OffsetFromRay f = offset(s, t);
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
        std::clamp(s + (st * gt - b * gs) / determinant, cell.s, cell.s + cell.s_size);
    const double next_t =
        std::clamp(t + (st * gs - a * gt) / determinant, cell.t, cell.t + cell.t_size);
    const OffsetFromRay next = offset(next_s, next_t);
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

bool PatchInRayFrame::approachPoint(const ParameterRectangle& cell, double distance,
                                    double tolerance, double& s, double& t) const {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostPointSteps; ++i) {
    const OffsetFromRay f = offset(s, t);
    const PlaceAlongRay g = place(s, t);
    const double ahead = g.z - distance, residual = f.squared() + ahead * ahead;
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
    s = std::clamp(s + (st * gt - b * gs) / determinant, cell.s, cell.s + cell.s_size);
    t = std::clamp(t + (st * gs - a * gt) / determinant, cell.t, cell.t + cell.t_size);
  }
  return false;
}

bool PatchInRayFrame::approachSide(const ParameterRectangle& cell, int side, double tolerance,
                                   double& s, double& t) const {
  const bool along_s = side < 2;
  const double low = along_s ? cell.s : cell.t, size = along_s ? cell.s_size : cell.t_size,
               high = low + size;
  s = cell.s + (side == 3 ? cell.s_size : 0);
  t = cell.t + (side == 1 ? cell.t_size : 0);
  double& w = along_s ? s : t;
  w = low + size / 2;
  for (int i = 0; i < kSideSteps; ++i) {
    const OffsetFromRay f = offset(s, t);
    const double dx = along_s ? f.xs : f.xt, dy = along_s ? f.ys : f.yt;
    const double squared = dx * dx + dy * dy;
    if (squared > 0) {
      w = std::clamp(w - (f.x * dx + f.y * dy) / squared, low, high);
    }
  }
  return offset(s, t).squared() <= tolerance * tolerance;
}

}  // namespace limitsurf
