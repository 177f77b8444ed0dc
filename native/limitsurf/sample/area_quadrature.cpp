// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_quadrature.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// Differences shrink by the same factor from rule to rule where the integrand is smooth. The error
/// of a rule is estimated by its last difference times the factor of its last two, times this, so
/// that an accidental agreement does less harm.
constexpr double kCaution = 8;

double errorAfter(double before, double last) {
  return before > 0 ? last * std::min(1., kCaution * last / before) : last;
}

/// The difference that follows these two, `steps` rules later.
double continued(double before, double last, int steps) {
  const double factor = before > 0 ? std::min(1., last / before) : 1;
  return last * std::pow(factor, steps);
}

/// The halves of four cubics; the points of each are `stride` apart, and the cubics are `step`
/// apart.
void halve(const double* p, int stride, int step, double* low, double* high) {
  for (int line = 0; line < 4; ++line, p += step, low += step, high += step) {
    const double a = p[0], b = p[stride], c = p[2 * stride], d = p[3 * stride];
    const double ab = (a + b) / 2, bc = (b + c) / 2, cd = (c + d) / 2;
    const double abc = (ab + bc) / 2, bcd = (bc + cd) / 2, middle = (abc + bcd) / 2;
    low[0] = a;
    low[stride] = ab;
    low[2 * stride] = abc;
    low[3 * stride] = high[0] = middle;
    high[stride] = bcd;
    high[2 * stride] = cd;
    high[3 * stride] = d;
  }
}

}  // namespace

void AreaQuadrature::clear() {
  sum_ = {};
  kept_.clear();
}

void AreaQuadrature::measure(Square& square, double relative, double absolute) {
  const AreaIntegrand integrand(square.points);
  square.rounding = integrand.rounding();
  const double one = integrand.quadrature(kGauss1), two = integrand.quadrature(kGauss2),
               three = integrand.quadrature(kGauss3);
  sum_.evaluations += 1 + 4 + 9;
  const double first = std::abs(three - two);
  const double tolerance = std::max({absolute, relative * three, square.rounding});
  square.area = three;
  square.error = first;
  const bool upright = integrand.isUpright();
  if (upright && square.error <= tolerance) {
    return;
  }
  square.area = integrand.quadrature(kGauss4);
  sum_.evaluations += 16;
  const double second = std::abs(square.area - three);
  square.error = std::max(errorAfter(first, second), continued(std::abs(two - one), first, 2));
  if (upright && square.error <= tolerance) {
    return;
  }
  const double six = integrand.quadrature(kGauss6);
  sum_.evaluations += 36;
  const double third = std::abs(six - square.area);
  square.error = std::max(errorAfter(second, third), continued(first, second, 3));
  square.area = six;
  if (upright) {
    return;
  }
  const AreaIntegrand::Folds folds = integrand.folds();
  if (folds.turned > 0) {
    // In a plane, the area is signed_area + 2 x the part that is turned over. The rule's points
    // have found that part, or they have not.
    const double found = (six - folds.signed_area) / 2;
    square.error = found > folds.turned / kCaution ? third : std::max(third, 2 * folds.turned);
  }
}

void AreaQuadrature::add(const BezierPatch& patch, double relative, double absolute) {
  Square square;
  for (int i = 0; i < 16; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      square.points[axis][i] = patch.points[i][axis];
    }
  }
  measure(square, relative, absolute);
  if (keep_) {
    kept_.push_back(square);
  } else {
    sum_.value += square.area;
    sum_.error += square.error + square.rounding;
  }
}

void AreaQuadrature::refine(double tolerance, int most) {
  if (most == 0) {
    return;
  }
  std::make_heap(kept_.begin(), kept_.end());
  double error = 0;
  for (const Square& square : kept_) {
    error += square.error;
  }
  for (int made = 0; made + 4 <= most && error > tolerance; made += 4) {
    const Square whole = kept_.front();
    if (!(whole.error > whole.rounding)) {
      return;
    }
    std::pop_heap(kept_.begin(), kept_.end());
    kept_.pop_back();
    error -= whole.error;
    Square strips[2], quarters[4];
    for (int axis = 0; axis < 3; ++axis) {
      halve(whole.points[axis], 4, 1, strips[0].points[axis], strips[1].points[axis]);
    }
    for (int quarter = 0; quarter < 4; quarter += 2) {
      for (int axis = 0; axis < 3; ++axis) {
        halve(strips[quarter / 2].points[axis], 1, 4, quarters[quarter].points[axis],
              quarters[quarter + 1].points[axis]);
      }
    }
    for (Square& quarter : quarters) {
      measure(quarter, 0, tolerance / kShare);
      error += quarter.error;
      kept_.push_back(quarter);
      std::push_heap(kept_.begin(), kept_.end());
    }
  }
}

SurfaceArea AreaQuadrature::result() const {
  SurfaceArea result = sum_;
  for (const Square& square : kept_) {
    result.value += square.area;
    result.error += square.error + square.rounding;
  }
  return result;
}

}  // namespace limitsurf
