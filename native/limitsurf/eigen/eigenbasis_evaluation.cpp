// SPDX-License-Identifier: Apache-2.0
//
// From modes to a face's control points and derivatives after any number of steps.
#include <algorithm>
#include <cmath>

#include "limitsurf/eigen/eigenbasis.h"

namespace limitsurf {
namespace {

template <typename Number>
Number power(Number base, int exponent, Number one) {
  for (; exponent > 0; exponent >>= 1, base = base * base) {
    if (exponent & 1) {
      one = one * base;
    }
  }
  return one;
}

double power(double base, int exponent) { return power(base, exponent, 1.); }

/// lambda^steps for values, first and second derivatives: times 1, 2^(steps + 1), 2^(steps + 2).
/// (2 lambda)^steps stays within the range of double where lambda^steps does not.
struct Powers {
  double by_order[3];

  Powers(double lambda, int steps) : Powers(Scaled{power(2 * lambda, steps)}, steps) {}

  struct Scaled {
    double value;  ///< 2^steps times what it stands for
  };
  Powers(const Scaled& number, int steps) {
    const double scaled = number.value;
    by_order[0] = std::ldexp(scaled, -steps);
    by_order[1] = 2 * scaled;
    by_order[2] = 4 * scaled;
  }
  double at(int functional) const { return by_order[functional == 0 ? 0 : functional < 3 ? 1 : 2]; }
};

/// p + q E: powers of what a step does to a pair of modes, mean + E with E^2 = forth back.
struct PairNumber {
  double p, q, square;

  friend PairNumber operator*(const PairNumber& a, const PairNumber& b) {
    return {a.p * b.p + a.square * a.q * b.q, a.p * b.q + a.q * b.p, a.square};
  }
};

PairNumber pairPower(const ModePair& pair, double scale, int exponent) {
  const double square = pair.forth * pair.back;
  return power(PairNumber{scale * pair.mean, scale, square}, exponent, PairNumber{1, 0, square});
}

/// [lambda, feeds; 0, outer]: powers of what a step does to a mode that feeds an outer one.
struct FeedNumber {
  double lambda, feeds, outer;

  friend FeedNumber operator*(const FeedNumber& a, const FeedNumber& b) {
    return {a.lambda * b.lambda, a.lambda * b.feeds + a.feeds * b.outer, a.outer * b.outer};
  }
};

/// 2^steps times what a mode has fed into an outer one after `steps` steps, at one a step.
double scaledFeed(double lambda, double outer, int steps) {
  return power(FeedNumber{2 * lambda, 2, 2 * outer}, steps, FeedNumber{1, 0, 1}).feeds;
}

using Functionals = Eigen::Array<double, GridWindow::kMaxCount, 1>;

Functionals applied(const GridWindow& window, const double* grid) {
  const double* corner = grid + window.b * tile_grid::kSize + window.a;
  PatchValues<double> patch{};
  switch (window.order) {
    case 0:
      evaluateWindow<0>(corner, tile_grid::kSize, window.u, window.v, patch);
      break;
    case 1:
      evaluateWindow<1>(corner, tile_grid::kSize, window.u, window.v, patch);
      break;
    default:
      evaluateWindow<2>(corner, tile_grid::kSize, window.u, window.v, patch);
  }
  Functionals result;
  result << patch.value, patch.du, patch.dv, patch.duu, patch.duv, patch.dvv;
  return result;
}

Functionals scaled(Functionals values, const Powers& powers, int count) {
  for (int d = 0; d < count; ++d) {
    values[d] *= powers.at(d);
  }
  return values;
}

Eigen::Array4d padded(const Points& points, int row) {
  return {points(row, 0), points(row, 1), points(row, 2), 0};
}

}  // namespace

template <typename Body>
void Eigenbasis::forEachTable(int face, const Points& coefficients, const Body& body) const {
  const auto coefficient = [&](int mode) { return padded(coefficients, mode); };
  for (int i = 0; i < fixedCount(); ++i) {
    body(fixed(face).tables[i], lambda_[1 + i], coefficient(1 + i));
  }
  const FaceTables& t = tables(sides(face));
  for (int m = 1; m <= spokeCount(); ++m) {
    for (const bool plus : {true, false}) {
      Part part[2];
      const int count = parts(m, plus, face, part);
      if (count == 0) {
        continue;
      }
      Eigen::Array4d cosine = Eigen::Array4d::Zero(), sine = cosine;
      for (int p = 0; p < count; ++p) {
        cosine += part[p].cosine * coefficient(part[p].mode);
        sine += part[p].sine * coefficient(part[p].mode);
      }
      const double lambda = lambda_[part[0].mode];
      body(t.sine[pairIndex(m, plus)], lambda, sine);
      if (!t.cosine.empty()) {
        body(t.cosine[pairIndex(m, plus)], lambda, cosine);
      }
    }
  }
  if (dart_) {
    for (int i = 0; i < dart_->count(); ++i) {
      if (i != dart_->pair().a && i != dart_->pair().b) {
        const int mode = firstSymmetric() + i;
        body(dart_->table(i, face), lambda_[mode], coefficient(mode));
      }
    }
  }
}

void Eigenbasis::controlGrid(int face, int steps, int ring_steps, const Points& coefficients,
                             const Eigen::Array4d outer_points[], Eigen::Array4d grid[]) const {
  const FaceTables& t = tables(sides(face));
  const OuterModes<double>& outer = t.outer_modes;
  const int outer_count = outer.count();
  std::fill_n(grid, tile_grid::kCells, Eigen::Array4d::Zero());
  Eigen::Array4d left_over[tile_grid::kOuter];  // of the outer points, besides the ring's modes
  std::copy_n(outer_points, outer_count, left_over);
  const auto add = [&](const Table& table, const Eigen::Array4d& in_grid,
                       const Eigen::Array4d& in_outer) {
    for (int c = 0; c < tile_grid::kCells; ++c) {
      grid[c] += table.grid[c] * in_grid;
    }
    for (int i = 0; i < outer_count; ++i) {
      left_over[i] -= table.outer[i] * in_outer;
    }
  };

  const Eigen::Array4d constant = padded(coefficients, 0);
  for (int i = 0; i < outer_count; ++i) {
    left_over[i] -= constant;
  }
  forEachTable(face, coefficients,
               [&](const Table& table, double lambda, const Eigen::Array4d& coefficient) {
                 const Eigen::Array4d before = power(lambda, ring_steps) * coefficient;
                 add(table, power(2 * lambda, steps - 1) * before, before);
               });
  for (const Chain& chain : chains_) {
    const double lambda = lambda_[chain.from];
    const Eigen::Array4d fed =
        power(lambda, ring_steps) * chain.rate / lambda * padded(coefficients, chain.from);
    add(table(chain.to, face), (steps - 1 + ring_steps) * power(2 * lambda, steps - 1) * fed,
        ring_steps * fed);
  }
  for (const ModePair& pair : pairs_) {
    const PairNumber ring = pairPower(pair, 1, ring_steps);
    const PairNumber all = ring * pairPower(pair, 2, steps - 1);
    const Eigen::Array4d a = padded(coefficients, pair.a), b = padded(coefficients, pair.b);
    add(table(pair.a, face), all.p * a + all.q * pair.back * b,
        ring.p * a + ring.q * pair.back * b);
    add(table(pair.b, face), all.p * b + all.q * pair.forth * a,
        ring.p * b + ring.q * pair.forth * a);
  }
  for (int q = 0; q < outer_count; ++q) {
    Eigen::Array4d coefficient = Eigen::Array4d::Zero();
    for (int i = 0; i < outer_count; ++i) {
      coefficient += outer.inverse()(q, i) * left_over[i];
    }
    coefficient *= power(2 * outer.lambda(q), steps - 1);
    if (rest_mode_ >= 0) {
      const double lambda = lambda_[rest_mode_];
      coefficient += scaledFeed(lambda, outer.lambda(q), steps - 1) * rest(face, q) *
                     power(lambda, ring_steps) * padded(coefficients, rest_mode_);
    }
    for (int c = 0; c < tile_grid::kCells; ++c) {
      grid[c] += t.outer[q].grid[c] * coefficient;
    }
  }
}

void Eigenbasis::weights(int face, int steps, int ring_steps, const GridWindow& window,
                         Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& outer_weights) const {
  const FaceTables& t = tables(sides(face));
  const OuterModes<double>& outer = t.outer_modes;
  const int count = window.count(), outer_count = outer.count();
  mode_weights.resize(count, modeCount());

  // Weights on the outer modes, then through W^-1 on the outer points.
  Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter> on_outer_modes;
  for (int q = 0; q < outer_count; ++q) {
    on_outer_modes.col(q) =
        scaled(applied(window, t.outer[q].grid), Powers(outer.lambda(q), steps - 1), count);
  }
  Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter> on_outer =
      Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter>::Zero();
  on_outer.leftCols(outer_count) = on_outer_modes.leftCols(outer_count) * outer.inverse();
  outer_weights = on_outer.topLeftCorner(count, outer_count);

  // A mode is seen through the grid after `steps` steps, less what the outer points hold of it
  // already. Both parts apart, since a Jordan chain counts their steps differently.
  struct Seen {
    Functionals grid, outer;
  };
  const auto see = [&](const Table& table, double lambda) {
    const double before = power(lambda, ring_steps);
    Seen seen;
    seen.grid = before * scaled(applied(window, table.grid), Powers(lambda, steps - 1), count);
    seen.outer.setZero();
    for (int i = 0; i < outer_count; ++i) {
      seen.outer += before * table.outer[i] * on_outer.col(i).array();
    }
    return seen;
  };

  // Of the constant mode, position has weight 1 and derivatives 0, less the outer points' share.
  mode_weights.col(0) = -outer_weights.rowwise().sum();
  mode_weights(0, 0) += 1;

  for (int i = 0; i < fixedCount(); ++i) {
    const Seen seen = see(fixed(face).tables[i], lambda_[1 + i]);
    mode_weights.col(1 + i) = (seen.grid - seen.outer).head(count);
  }
  for (int m = 1; m <= spokeCount(); ++m) {
    for (const bool plus : {true, false}) {
      Part part[2];
      const int parts_count = parts(m, plus, face, part);
      if (parts_count == 0) {
        continue;
      }
      const double lambda = lambda_[part[0].mode];
      const int pair = pairIndex(m, plus);
      Functionals sine = Functionals::Zero(), cosine = Functionals::Zero();
      const Seen s = see(t.sine[pair], lambda);
      sine = s.grid - s.outer;
      if (!t.cosine.empty()) {
        const Seen c = see(t.cosine[pair], lambda);
        cosine = c.grid - c.outer;
      }
      for (int p = 0; p < parts_count; ++p) {
        mode_weights.col(part[p].mode) =
            (part[p].cosine * cosine + part[p].sine * sine).head(count);
      }
    }
  }

  if (dart_) {
    for (int i = 0; i < dart_->count(); ++i) {
      if (i != dart_->pair().a && i != dart_->pair().b) {
        const int mode = firstSymmetric() + i;
        const Seen seen = see(dart_->table(i, face), lambda_[mode]);
        mode_weights.col(mode) = (seen.grid - seen.outer).head(count);
      }
    }
  }
  for (const ModePair& pair : pairs_) {
    const PairNumber ring = pairPower(pair, 1, ring_steps);
    const PairNumber all = ring * pairPower(pair, 2, steps - 1);
    const Table tables[2] = {table(pair.a, face), table(pair.b, face)};
    // A mode has become (p, q feeds) times itself and the other one.
    const auto seeFed = [&](int own, double feeds) -> Functionals {
      Functionals result = Functionals::Zero();
      for (const int i : {own, 1 - own}) {
        const double factor = i == own ? 1 : feeds;
        const Powers powers(Powers::Scaled{factor * (i == own ? all.p : all.q)}, steps - 1);
        result += scaled(applied(window, tables[i].grid), powers, count);
        for (int c = 0; c < outer_count; ++c) {
          result -=
              factor * (i == own ? ring.p : ring.q) * tables[i].outer[c] * on_outer.col(c).array();
        }
      }
      return result;
    };
    mode_weights.col(pair.a) = seeFed(0, pair.forth).head(count);
    mode_weights.col(pair.b) = seeFed(1, pair.back).head(count);
  }

  // (lambda + nilpotent)^n = lambda^n + n lambda^(n - 1) (nilpotent)
  for (const Chain& chain : chains_) {
    const double lambda = lambda_[chain.from];
    const Seen seen = see(table(chain.to, face), lambda);
    const int all_steps = steps - 1 + ring_steps;
    mode_weights.col(chain.from) +=
        (chain.rate / lambda * (all_steps * seen.grid - ring_steps * seen.outer))
            .head(count)
            .matrix();
  }
  if (rest_mode_ >= 0) {
    const double lambda = lambda_[rest_mode_], before = power(lambda, ring_steps);
    for (int q = 0; q < outer_count; ++q) {
      const Powers fed(Powers::Scaled{scaledFeed(lambda, outer.lambda(q), steps - 1)}, steps - 1);
      mode_weights.col(rest_mode_) +=
          before * rest(face, q) *
          scaled(applied(window, t.outer[q].grid), fed, count).head(count).matrix();
    }
  }
}

}  // namespace limitsurf
