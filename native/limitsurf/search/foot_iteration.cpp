// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/foot_iteration.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

using Values = BezierPatch::Values;

/// Newton's iteration converges quadratically, so these limits only end searches on degenerate
/// patches. Both are chosen, not derived.
constexpr int kMostIterations = 40, kMostHalvings = 30;
/// After a step of Newton's as short as this the next one, its square, is shorter than rounding.
constexpr double kLastStep = 1e-7;
/// The last step may raise the squared distance by this part, which is more than its rounding.
constexpr double kStepRounding = 1e-12;
/// Parameters that differ by less are the same.
constexpr double kArrived = 1e-15;
/// A Hessian whose determinant is at most this part of the product of its diagonal is not safely
/// positive definite: the step of Gauss and Newton replaces Newton's.
constexpr double kIndefinite = 1e-12;
/// The same for the matrix of Gauss and Newton, which is never indefinite: below this it is
/// singular but for rounding, and only one parameter moves.
constexpr double kSingular = 1e-14;

/// A step of the parameters.
struct Step {
  double s = 0, t = 0;
};

/// The derivatives of half the squared distance. The value is the offset from the point.
struct Gradient {
  explicit Gradient(const Values& at) : s(dot(at.value, at.ds)), t(dot(at.value, at.dt)) {}
  double s, t;
};

/// The Hessian of half the squared distance, or an approximation of it that is positive.
struct Hessian {
  explicit Hessian(const Values& at)
      : tangents{dot(at.ds, at.ds), dot(at.dt, at.dt), dot(at.ds, at.dt)},
        ss(tangents[0] + dot(at.value, at.dss)),
        tt(tangents[1] + dot(at.value, at.dtt)),
        st(tangents[2] + dot(at.value, at.dst)),
        is_newton(ss > 0 && tt > 0) {}

  /// Newton's step, where that leads down for certain; else the step of Gauss and Newton, whose
  /// matrix takes the Hessian's place; else a step along the parameter with the larger derivative.
  Step step(const Gradient& g) {
    double determinant = ss * tt - st * st;
    if (!(ss > 0 && determinant > kIndefinite * ss * tt)) {
      is_newton = false;
      ss = tangents[0];
      tt = tangents[1];
      st = tangents[2];
      determinant = ss * tt - st * st;
    }
    if (determinant > kSingular * ss * tt) {
      return {(st * g.t - tt * g.s) / determinant, (st * g.s - ss * g.t) / determinant};
    }
    Step step;
    if (ss > 0 || tt > 0) {
      (ss > tt ? step.s : step.t) = ss > tt ? -g.s / ss : -g.t / tt;
    }
    return step;
  }

  double tangents[3];  ///< ss, tt and st of the matrix of Gauss and Newton
  double ss, tt, st;
  bool is_newton;  ///< the matrix is the Hessian itself, with a positive diagonal
};

/// A step of the second parameter alone; if that has arrived, a step of the first alone.
void moveAlong(double g1, double g2, double h1, double h2, double& d1, double& d2) {
  d1 = 0;
  d2 = h2 > 0 ? -g2 / h2 : 0;
  if (std::abs(d2) < kArrived) {
    d2 = 0;
    d1 = h1 > 0 ? -g1 / h1 : 0;
  }
}

bool leadsOut(double x, double step, double low, double high) {
  return (x <= low && step < 0) || (x >= high && step > 0);
}

/// minimizeDistance(), as steps from the present (s, t).
class FootIteration {
 public:
  FootIteration(const SearchKernels& kernels, const BezierPatch& patch,
                const BezierPatch::Point& away, const ParameterRectangle& on, double& s, double& t)
      : kernels_(kernels),
        patch_(patch),
        away_(away),
        s_size_(on.s_size),
        t_size_(on.t_size),
        s0_(on.s),
        s1_(on.s + on.s_size),
        t0_(on.t),
        t1_(on.t + on.t_size),
        s_(s),
        t_(t) {
    squared_ = evaluate(s_, t_, at_, found_);
  }

  FootSearch run(double slack, double enough, double radius) {
    for (int i = 0; i < kMostIterations; ++i) {
      const Gradient g(at_);
      const bool free_s = !((s_ <= s0_ && g.s >= 0) || (s_ >= s1_ && g.s <= 0));
      const bool free_t = !((t_ <= t0_ && g.t >= 0) || (t_ >= t1_ && g.t <= 0));
      if (!free_s && !free_t) {
        return FootSearch::arrived;
      }
      if (isBeyond(g, slack, enough) && distance() <= radius) {
        return FootSearch::beyond;
      }
      Hessian h(at_);
      const Step step = activeStep(g, h, free_s, free_t);
      const double part = partInside(step);
      const bool is_last =
          h.is_newton && part == 1 && std::abs(step.s) + std::abs(step.t) < kLastStep;
      switch (descend(step, part, is_last)) {
        case Descent::kNoMove:
          return FootSearch::arrived;
        case Descent::kNoDescent:
          return is_last || (free_s ? std::abs(g.s) * s_size_ : 0) +
                                    (free_t ? std::abs(g.t) * t_size_ : 0) <=
                                slack
                     ? FootSearch::arrived
                     : FootSearch::failed;
        case Descent::kDescended:
          break;
      }
      if (is_last && !fallsFromSide()) {
        return FootSearch::arrived;
      }
    }
    return FootSearch::failed;
  }

  const BezierPatch::Point& found() const { return found_; }
  double distance() const { return std::sqrt(dot(at_.value, at_.value)); }

 private:
  enum class Descent { kDescended, kNoDescent, kNoMove };

  /// Returns the squared distance less that of `away`, and sets the value to the offset of `point`.
  double evaluate(double s, double t, Values& at, BezierPatch::Point& point) const {
    static_assert(sizeof(Values) == sizeof(double[6][4]), "the kernel writes all values");
    kernels_.evaluate(numbersOf(patch_.points), s, t, numbersOf(&at.value));
    point = at.value;
    at.value = point - away_;
    const double squared = dot(point, at.value - away_);
    return squared;
  }

  /// A convex function lies above its tangents.
  bool isBeyond(const Gradient& g, double slack, double enough) const {
    const double falls =
        std::max(g.s * (s_ - s0_), g.s * (s_ - s1_)) + std::max(g.t * (t_ - t0_), g.t * (t_ - t1_));
    return squared_ - 2 * falls - slack - kStepRounding * std::abs(squared_) >= enough;
  }

  /// A step that respects the active sides. A side on which the iteration stands, and out of which
  /// the step would lead, stays active for this step: the other parameter moves or, if that has
  /// arrived, this one moves inwards.
  Step activeStep(const Gradient& g, Hessian& h, bool free_s, bool free_t) const {
    Step step;
    if (free_s && free_t) {
      step = h.step(g);
      if (leadsOut(s_, step.s, s0_, s1_)) {
        moveAlong(g.s, g.t, h.ss, h.tt, step.s, step.t);
      } else if (leadsOut(t_, step.t, t0_, t1_)) {
        moveAlong(g.t, g.s, h.tt, h.ss, step.t, step.s);
      }
    } else if (free_s) {
      moveAlong(g.t, g.s, h.tt, h.ss, step.t, step.s);
    } else {
      moveAlong(g.s, g.t, h.ss, h.tt, step.s, step.t);
    }
    return step;
  }

  /// The part of a step that stays in the square: a step that leads out is cut where it leaves the
  /// square, and the side it meets becomes active.
  double partInside(const Step& step) const {
    double part = 1;
    const auto cut = [&](double from, double length, double low, double high) {
      if (length > 0 && from + length > high) {
        part = std::min(part, (high - from) / length);
      } else if (length < 0 && from + length < low) {
        part = std::min(part, (low - from) / length);
      }
    };
    cut(s_, step.s, s0_, s1_);
    cut(t_, step.t, t0_, t1_);
    return part;
  }

  /// Goes a part of the step, halved until the distance does not grow.
  Descent descend(const Step& step, double part, bool is_last) {
    Values next;
    BezierPatch::Point point;
    for (int halvings = 0; halvings < kMostHalvings; ++halvings, part /= 2) {
      const double next_s = std::clamp(s_ + part * step.s, s0_, s1_),
                   next_t = std::clamp(t_ + part * step.t, t0_, t1_);
      if (next_s == s_ && next_t == t_) {
        return Descent::kNoMove;
      }
      const double next_squared = evaluate(next_s, next_t, next, point);
      if (next_squared <= squared_ ||
          (is_last && next_squared <= squared_ + kStepRounding * std::abs(squared_))) {
        s_ = next_s;
        t_ = next_t;
        squared_ = next_squared;
        at_ = next;
        found_ = point;
        return Descent::kDescended;
      }
    }
    return Descent::kNoDescent;
  }

  /// Whether the iteration stands on a side of the square from which the distance falls inwards.
  bool fallsFromSide() const {
    const Gradient g(at_);
    return (s_ == s0_ && g.s < 0) || (s_ == s1_ && g.s > 0) || (t_ == t0_ && g.t < 0) ||
           (t_ == t1_ && g.t > 0);
  }

  const SearchKernels& kernels_;
  const BezierPatch& patch_;
  const BezierPatch::Point away_;
  const double s_size_, t_size_, s0_, s1_, t0_, t1_;
  double &s_, &t_;
  Values at_;
  BezierPatch::Point found_;
  double squared_;
};

}  // namespace

FootSearch minimizeDistance(const SearchKernels& kernels, const BezierPatch& patch,
                            const BezierPatch::Point& away, const ParameterRectangle& on,
                            double slack, double enough, double radius, double& s, double& t,
                            BezierPatch::Point& found) {
  FootIteration iteration(kernels, patch, away, on, s, t);
  const FootSearch search = iteration.run(slack, enough, radius);
  found = iteration.found();
  return search;
}

}  // namespace limitsurf
