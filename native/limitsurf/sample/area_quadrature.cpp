// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_quadrature.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/sample/area_folds.h"
#include "limitsurf/sample/area_kernels.h"

namespace limitsurf {
namespace {

/// Differences shrink by about the same factor from rule to rule where the integrand is smooth. The
/// error of a rule is estimated by its last difference times the factor of its last two, times
/// this.
constexpr double kCaution = 8;
/// Two rules may agree by accident. So an error is taken to be no smaller than these parts of the
/// last difference and of the one before. Measured: of the 4,896 patches of uneven, noisy and
/// folded sheets on which these constants were chosen, none has a larger error than stated. Without
/// the second constant some had errors 200 times as large; half its square root or twice the first
/// one is too little.
constexpr double kLeastOfLast = 1. / 8, kLeastOfBefore = 1. / 2048;
/// Points of a rule that find less than one part in so many of what is turned over have missed it.
constexpr double kFewFound = 8;

double errorAfter(double before, double last) {
  const double factor = before > 0 ? std::min(1., kCaution * last / before) : 1;
  return std::max(last * std::max(factor, kLeastOfLast), kLeastOfBefore * before);
}

/// The difference that follows these two, `steps` rules later.
double continued(double before, double last, int steps) {
  const double factor = before > 0 ? std::min(1., last / before) : 1;
  for (int step = 0; step < steps; ++step) {
    last *= factor;
  }
  return last;
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

struct AreaQuadrature::NextRule {
  AreaKernels::Rule rule;
  int points;      ///< of the rule
  int difference;  ///< the number of the difference between the rule before and this one
  /// The error is at least what would be the difference if the last two went on falling for so many
  /// rules.
  int rules;
};

void AreaQuadrature::measure(std::vector<AreaSquare>& squares) {
  open_.clear();
  constexpr std::size_t kBlock = SquareBlock::kCount;
  for (std::size_t first = 0; first < squares.size(); first += kBlock) {
    measureFirst(squares, first, std::min(kBlock, squares.size() - first));
  }
  const AreaKernels& kernels = AreaKernels::get();
  measureOpen(squares, {kernels.six, 36, 3, 3});
  open_.erase(std::remove_if(open_.begin(), open_.end(),
                             [&](const Open& open) { return isDone(squares[open.square], open); }),
              open_.end());
  measureOpen(squares, {kernels.eight, 64, 4, 3});
}

bool AreaQuadrature::isDone(AreaSquare& square, const Open& open) {
  const double before = open.differences[2], last = open.differences[3];
  if (open.upright) {
    return std::max(continued(before, last, 3), kLeastOfBefore * last) > tolerance(square);
  }
  const AreaFolds::Parts parts = AreaFolds(square.points).parts();
  if (parts.turned > 0) {
    // In a plane, the area is signed_area + 2 x the part that is turned over. The rule's points
    // have found that part, or they have not.
    const double found = (square.area - parts.signed_area) / 2;
    square.error = found > parts.turned / kFewFound ? last : std::max(last, 2 * parts.turned);
  }
  return true;
}

void AreaQuadrature::measureFirst(std::vector<AreaSquare>& squares, std::size_t first,
                                  std::size_t count) {
  const AreaKernels& kernels = AreaKernels::get();
  SquareBlock block;
  for (std::size_t i = 0; i < SquareBlock::kCount; ++i) {
    put(squares[first + std::min(i, count - 1)], static_cast<int>(i), block);
  }
  FirstRules rules;
  kernels.first_rules(block, rules);
  Open open[SquareBlock::kCount];
  bool is_open[SquareBlock::kCount], any_open = false;
  for (std::size_t i = 0; i < count; ++i) {
    AreaSquare& square = squares[first + i];
    square.rounding = rules.rounding[i];
    square.area = rules.three[i];
    square.evaluations = 1 + 4 + 9;
    open[i].square = first + i;
    open[i].upright = rules.upright[i] > 0 || AreaFolds(square.points).isUpright();
    open[i].differences[0] = std::abs(rules.two[i] - rules.one[i]);
    open[i].differences[1] = std::abs(rules.three[i] - rules.two[i]);
    square.error = std::max(open[i].differences[1], kLeastOfBefore * open[i].differences[0]);
    is_open[i] = !(open[i].upright && square.error <= tolerance(square));
    any_open |= is_open[i];
  }
  if (!any_open) {
    return;
  }
  // Most squares need the next rule as well, and they are in the block already.
  const NextRule next = {kernels.four, 16, 2, 2};
  double areas[SquareBlock::kCount];
  next.rule(block, areas);
  for (std::size_t i = 0; i < count; ++i) {
    if (is_open[i] && !isExact(squares[first + i], open[i], areas[i], next)) {
      open_.push_back(open[i]);
    }
  }
}

bool AreaQuadrature::isExact(AreaSquare& square, Open& open, double area, const NextRule& next) {
  square.evaluations += next.points;
  double* const d = open.differences + next.difference;
  d[0] = std::abs(area - square.area);
  square.area = area;
  square.error = std::max(errorAfter(d[-1], d[0]), continued(d[-2], d[-1], next.rules));
  return open.upright && square.error <= tolerance(square);
}

void AreaQuadrature::measureOpen(std::vector<AreaSquare>& squares, const NextRule& next) {
  std::size_t still_open = 0;
  SquareBlock block;
  double areas[SquareBlock::kCount];
  for (std::size_t first = 0; first < open_.size(); first += SquareBlock::kCount) {
    const std::size_t count = std::min<std::size_t>(SquareBlock::kCount, open_.size() - first);
    for (std::size_t i = 0; i < SquareBlock::kCount; ++i) {
      put(squares[open_[first + std::min(i, count - 1)].square], static_cast<int>(i), block);
    }
    next.rule(block, areas);
    for (std::size_t i = 0; i < count; ++i) {
      Open open = open_[first + i];
      if (!isExact(squares[open.square], open, areas[i], next)) {
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

}  // namespace limitsurf
