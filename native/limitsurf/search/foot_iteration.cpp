// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/foot_iteration.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

using Values = BezierPatch::Values;

constexpr int kMostIterations = 40, kMostHalvings = 30;
/// Steps of Newton's at which the next would be nothing but rounding.
constexpr double kLastStep = 1e-7;
/// By how much the last step may seem to lead up.
constexpr double kStepRounding = 1e-12;
/// Parameters that differ by so little are the same.
constexpr double kArrived = 1e-15;

double dot(const BezierPatch::Point& a, const BezierPatch::Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A step for the second parameter alone; where it has arrived, one for the first.
void along(double g1, double g2, double h1, double h2, double& d1, double& d2) {
  d1 = 0;
  d2 = h2 > 0 ? -g2 / h2 : 0;
  if (std::abs(d2) < kArrived) {
    d2 = 0;
    d1 = h1 > 0 ? -g1 / h1 : 0;
  }
}

/// Whether on a side of the cell the distance falls towards its inside.
bool fallsFromSide(const ParameterSquare& cell, double s, double t, const Values& at) {
  const double gs = dot(at.value, at.ds), gt = dot(at.value, at.dt);
  return (s == cell.s && gs < 0) || (s == cell.s + cell.size && gs > 0) ||
         (t == cell.t && gt < 0) || (t == cell.t + cell.size && gt > 0);
}

bool leadsOut(double x, double step, double low, double high) {
  return (x <= low && step < 0) || (x >= high && step > 0);
}

}  // namespace

bool minimizeDistance(const BezierPatch& patch, const ParameterSquare& cell, double slack,
                      double& s, double& t) {
  const double s1 = cell.s + cell.size, t1 = cell.t + cell.size;
  Values at, next;
  patch.evaluate<2>(s, t, at);
  double f = dot(at.value, at.value);
  for (int i = 0; i < kMostIterations; ++i) {
    const double gs = dot(at.value, at.ds), gt = dot(at.value, at.dt);
    const double ss = dot(at.ds, at.ds), tt = dot(at.dt, at.dt), st = dot(at.ds, at.dt);
    double hss = ss + dot(at.value, at.dss), htt = tt + dot(at.value, at.dtt),
           hst = st + dot(at.value, at.dst);
    const bool free_s = !((s <= cell.s && gs >= 0) || (s >= s1 && gs <= 0));
    const bool free_t = !((t <= cell.t && gt >= 0) || (t >= t1 && gt <= 0));
    if (!free_s && !free_t) {
      return true;
    }
    double ds = 0, dt = 0;
    bool newton = hss > 0 && htt > 0;
    if (free_s && free_t) {
      double determinant = hss * htt - hst * hst;
      if (!(hss > 0 && determinant > 1e-12 * hss * htt)) {  // Gauss and Newton's
        newton = false;
        hss = ss;
        htt = tt;
        hst = st;
        determinant = hss * htt - hst * hst;
      }
      if (determinant > 1e-14 * hss * htt) {
        ds = (hst * gt - htt * gs) / determinant;
        dt = (hst * gs - hss * gt) / determinant;
      } else if (hss > 0 || htt > 0) {  // along the steepest side
        (hss > htt ? ds : dt) = hss > htt ? -gs / hss : -gt / htt;
      }
    }
    // A side on which the iteration stands, and out of which the step leads, stays active for
    // this step: the other parameter moves, or where it has arrived, this one inwards.
    if (free_s && free_t) {
      if (leadsOut(s, ds, cell.s, s1)) {
        along(gs, gt, hss, htt, ds, dt);
      } else if (leadsOut(t, dt, cell.t, t1)) {
        along(gt, gs, htt, hss, dt, ds);
      }
    } else if (free_s) {
      along(gt, gs, htt, hss, dt, ds);
    } else {
      along(gs, gt, hss, htt, ds, dt);
    }
    // A step that leads out of the cell is cut off where it leaves; the side then becomes active.
    double part = 1;
    const auto cut = [&](double from, double step, double low, double high) {
      if (step > 0 && from + step > high) {
        part = std::min(part, (high - from) / step);
      } else if (step < 0 && from + step < low) {
        part = std::min(part, (low - from) / step);
      }
    };
    cut(s, ds, cell.s, s1);
    cut(t, dt, cell.t, t1);
    // Newton's next step would be the square of this one.
    const bool last = newton && part == 1 && std::abs(ds) + std::abs(dt) < kLastStep;
    bool lower = false;
    for (int halvings = 0; halvings < kMostHalvings && !lower; ++halvings, part /= 2) {
      const double next_s = std::clamp(s + part * ds, cell.s, s1),
                   next_t = std::clamp(t + part * dt, cell.t, t1);
      if (next_s == s && next_t == t) {
        return true;
      }
      patch.evaluate<2>(next_s, next_t, next);
      const double next_f = dot(next.value, next.value);
      lower = next_f <= f || (last && next_f <= f * (1 + kStepRounding));
      if (lower) {
        s = next_s;
        t = next_t;
        f = next_f;
        at = next;
      }
    }
    if (!lower) {
      return last || (std::abs(free_s ? gs : 0) + std::abs(free_t ? gt : 0)) * cell.size <= slack;
    }
    if (last && !fallsFromSide(cell, s, t, at)) {
      return true;
    }
  }
  return false;
}

}  // namespace limitsurf
