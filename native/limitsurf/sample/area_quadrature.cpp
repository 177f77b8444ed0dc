// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_quadrature.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/sample/area_folds.h"
#include "limitsurf/sample/area_kernels.h"

namespace limitsurf {
namespace {

// How much larger than estimated from coefficients of two degrees the factor may be by which they
// shrink from one degree to the next, and for how many degrees they are taken to shrink beyond the
// highest that a rule tells: fewer than those up to the degree at which the rule fails, which is
// twice the number of its points. Chosen such that no error was larger than stated by more than a
// tenth of a billionth of the area on the 98,056 patches of smooth, uneven, noisy and folded sheets
// of quads and triangles, around extraordinary vertices too; one degree more made some larger.

double errorOfFour(double highest, double lower) {
  // The coefficients are of degrees 3 and 1. They shrink for 5 degrees.
  const double shrinkage = std::min(1., highest / lower);
  return std::sqrt(highest) * shrinkage * std::sqrt(std::sqrt(shrinkage));
}

double errorOfSix(double highest, double lower) {
  // The coefficients are of degrees 5 and 3. They shrink for 4 degrees, by 1.5 times the factor.
  return std::sqrt(highest) * std::min(1., 1.5 * 1.5 * 1.5 * 1.5 * highest / lower);
}

/// `change` is the difference from the rule of 6 points.
double errorOfEight(double highest, double lower, double change) {
  // The coefficients are of degrees 7 and 3. They shrink for 8 degrees, by 1.5 times the factor.
  // The change is as large as the coefficients of degree 12.
  const double factor = std::min(1., 1.5 * std::sqrt(std::sqrt(std::sqrt(highest / lower))));
  const double squared = factor * factor;
  return std::max(change, std::sqrt(highest) * squared * squared * squared * factor) * factor;
}

/// Where a rule of 6 points has left these coefficients, what 8 points may leave at best.
double leastOfEight(double highest, double lower) {
  const double shrinkage = std::min(1., highest / lower);
  return std::sqrt(highest) * shrinkage * shrinkage;
}

/// Points of a rule that find less than one part in so many of what is turned over have missed it.
constexpr double kFewFound = 8;
/// What is stated at least, as a part of what is allowed.
constexpr double kLeastStated = 0.1;

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

double tolerance(const AreaSquare& square) {
  return std::max({square.absolute, square.relative * square.area, square.rounding});
}

/// Puts a square into a block.
void put(const AreaSquare& square, int place, SquareBlock& block) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 16; ++i) {
      block.points[axis][i][place] = square.points[axis][i];
    }
  }
}

}  // namespace

AreaSquare::AreaSquare(const BezierPatch& patch, double relative_error, double absolute_error)
    : relative(relative_error), absolute(absolute_error) {
  for (int i = 0; i < 16; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      points[axis][i] = patch.points[i][axis];
    }
  }
}

struct AreaQuadrature::Rule {
  AreaKernels::Rule apply;
  int side;  ///< the number of its points along a side
};

void AreaQuadrature::measure(std::vector<AreaSquare>& squares, bool nearly_flat) {
  const AreaKernels& kernels = AreaKernels::get();
  const Rule four = {kernels.four, 4}, six = {kernels.six, 6}, eight = {kernels.eight, 8};
  open_.clear();
  constexpr std::size_t kBlock = SquareBlock::kCount;
  for (std::size_t first = 0; first < squares.size(); first += kBlock) {
    measureFirst(squares, first, std::min(kBlock, squares.size() - first),
                 nearly_flat ? four : six);
  }
  if (nearly_flat) {
    measureOpen(squares, six);
  }
  open_.erase(std::remove_if(open_.begin(), open_.end(),
                             [&](const Open& open) { return isDone(squares[open.square], open); }),
              open_.end());
  measureOpen(squares, eight);
}

bool AreaQuadrature::isDone(AreaSquare& square, const Open& open) {
  if (!open.upright) {
    const AreaFolds::Parts parts = AreaFolds(square.points).parts();
    if (parts.turned > 0) {
      // In a plane, the area is signed_area + 2 x the part that is turned over. The rule's points
      // have found that part, or they have not. Beside kinks, coefficients do not shrink.
      const double found = (square.area - parts.signed_area) / 2;
      square.error = std::sqrt(open.highest);
      if (!(found > parts.turned / kFewFound)) {
        square.error = std::max(square.error, 2 * parts.turned);
      }
    }
    return true;
  }
  return leastOfEight(open.highest, open.lower) > tolerance(square);
}

void AreaQuadrature::measureFirst(std::vector<AreaSquare>& squares, std::size_t first,
                                  std::size_t count, const Rule& rule) {
  SquareBlock block;
  for (std::size_t i = 0; i < SquareBlock::kCount; ++i) {
    put(squares[first + std::min(i, count - 1)], static_cast<int>(i), block);
  }
  SquareShapes shapes;
  AreaKernels::get().shapes(block, shapes);
  RuleResults results;
  rule.apply(block, results);
  for (std::size_t i = 0; i < count; ++i) {
    AreaSquare& square = squares[first + i];
    square.rounding = shapes.rounding[i];
    square.normal = {results.normal[0][i], results.normal[1][i], results.normal[2][i]};
    square.evaluations = 0;
    Open open = {first + i, shapes.upright[i] > 0 || AreaFolds(square.points).isUpright(),
                 results.highest[i], results.lower[i]};
    if (!isExact(square, open, rule, results.area[i])) {
      open_.push_back(open);
    }
  }
}

bool AreaQuadrature::isExact(AreaSquare& square, Open& open, const Rule& rule, double area) {
  const double before = square.area;
  square.area = area;
  square.evaluations += rule.side * rule.side;
  if (!(open.highest > 0)) {
    square.error = 0;
  } else if (rule.side == 4) {
    square.error = errorOfFour(open.highest, open.lower);
  } else if (rule.side == 6) {
    square.error = errorOfSix(open.highest, open.lower);
  } else {
    square.error = errorOfEight(open.highest, open.lower, std::abs(area - before));
  }
  square.error = std::max(square.error, kLeastStated * square.relative * area);
  return open.upright && square.error <= tolerance(square);
}

void AreaQuadrature::measureOpen(std::vector<AreaSquare>& squares, const Rule& rule) {
  std::size_t still_open = 0;
  SquareBlock block;
  RuleResults results;
  for (std::size_t first = 0; first < open_.size(); first += SquareBlock::kCount) {
    const std::size_t count = std::min<std::size_t>(SquareBlock::kCount, open_.size() - first);
    for (std::size_t i = 0; i < SquareBlock::kCount; ++i) {
      put(squares[open_[first + std::min(i, count - 1)].square], static_cast<int>(i), block);
    }
    rule.apply(block, results);
    for (std::size_t i = 0; i < count; ++i) {
      Open open = open_[first + i];
      open.highest = results.highest[i];
      open.lower = results.lower[i];
      if (!isExact(squares[open.square], open, rule, results.area[i])) {
        open_[still_open++] = open;
      }
    }
  }
  open_.resize(still_open);
}

void RefinedArea::start(const std::vector<AreaSquare>& squares) {
  squares_ = squares;
  quadrature_.measure(squares_);
  evaluations_ = 0;
  for (const AreaSquare& square : squares_) {
    evaluations_ += square.evaluations;
  }
}

void RefinedArea::refine(double tolerance, int most) {
  std::make_heap(squares_.begin(), squares_.end());
  double error = 0;
  for (const AreaSquare& square : squares_) {
    error += square.error;
  }
  for (int made = 0; made + 4 <= most && error > tolerance; made += 4) {
    const AreaSquare whole = squares_.front();
    if (!(whole.error > whole.rounding)) {
      return;
    }
    std::pop_heap(squares_.begin(), squares_.end());
    squares_.pop_back();
    error -= whole.error;
    AreaSquare strips[2];
    quarters_.resize(4);
    for (int axis = 0; axis < 3; ++axis) {
      halve(whole.points[axis], 4, 1, strips[0].points[axis], strips[1].points[axis]);
    }
    for (std::size_t quarter = 0; quarter < 4; quarter += 2) {
      for (int axis = 0; axis < 3; ++axis) {
        halve(strips[quarter / 2].points[axis], 1, 4, quarters_[quarter].points[axis],
              quarters_[quarter + 1].points[axis]);
      }
    }
    for (AreaSquare& quarter : quarters_) {
      quarter.relative = 0;
      quarter.absolute = tolerance / kShare;
    }
    quadrature_.measure(quarters_);
    for (const AreaSquare& quarter : quarters_) {
      error += quarter.error;
      evaluations_ += quarter.evaluations;
      squares_.push_back(quarter);
      std::push_heap(squares_.begin(), squares_.end());
    }
  }
}

SurfaceArea RefinedArea::result() const {
  SurfaceArea result;
  for (const AreaSquare& square : squares_) {
    result.value += square.area;
    result.error += square.error + square.rounding;
  }
  result.evaluations = evaluations_;
  return result;
}

Vector3 RefinedArea::normal() const {
  Vector3 sum = Vector3::Zero();
  for (const AreaSquare& square : squares_) {
    sum += square.normal;
  }
  return sum;
}

}  // namespace limitsurf
