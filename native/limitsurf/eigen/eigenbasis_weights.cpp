// SPDX-License-Identifier: Apache-2.0
//
// Weights of a face's value and derivatives after any number of steps, on the modes of the ring and
// on the outer points: the eigenbasis functions of section 3.2 of Lacewell & Burley 2007 (after
// Stam 1998, equation 15), times the powers of the eigenvalues.
#include <cmath>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/large_ring.h"
#include "limitsurf/eigen/mode_powers.h"

namespace limitsurf {
namespace {

/// lambda^steps as it multiplies values, first and second derivatives: times 1, 2^(steps + 1) and
/// 2^(steps + 2).
struct Powers {
  double by_order[3];

  Powers(double lambda, int steps) : Powers(Scaled{power(2 * lambda, steps)}, steps) {}

  struct Scaled {
    double value;  ///< 2^steps times the number that it stands for
  };
  Powers(const Scaled& number, int steps) {
    const double scaled = number.value;
    by_order[0] = std::ldexp(scaled, -steps);
    by_order[1] = 2 * scaled;
    by_order[2] = 4 * scaled;
  }
  double at(int functional) const { return by_order[functional == 0 ? 0 : functional < 3 ? 1 : 2]; }
};

/// One number for each functional: value; du, dv; duu, duv, dvv.
using Functionals = Eigen::Array<double, GridWindow::kMaxCount, 1>;

/// The functionals of a mode whose values on the grid are given.
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

}  // namespace

/// Fills the weights of one window, group of modes by group of modes.
class Eigenbasis::WindowWeights {
 public:
  WindowWeights(const Eigenbasis& basis, int face, int steps, int ring_steps,
                const GridWindow& window, Eigen::MatrixXd& mode_weights,
                Eigen::MatrixXd& outer_weights)
      : basis_(basis),
        tables_(basis.tables(basis.sides(face))),
        outer_(tables_.outer_modes),
        outer_count_(outer_.count()),
        face_(face),
        steps_(steps),
        ring_steps_(ring_steps),
        window_(window),
        count_(window.count()),
        mode_weights_(mode_weights),
        outer_weights_(outer_weights) {
    mode_weights_.resize(count_, basis.modeCount());
  }

  void compute() {
    setOuterPoints();
    setConstant();
    setFixedModes();
    setSpokeModes();
    setSymmetricModes();
    for (const ModePair& pair : basis_.pairs_) {
      setPair(pair);
    }
    for (const Chain& chain : basis_.chains_) {
      addChain(chain);
    }
    addFeedIntoOuterModes();
  }

 private:
  using OuterFunctionals = Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter>;

  /// A mode as the window sees it: through the grid after all steps, less what the outer points
  /// hold of the mode already. Both parts stand apart, because a Jordan chain counts their steps
  /// differently.
  struct Seen {
    Functionals grid, outer;
  };

  Seen see(const Table& table, double lambda) const {
    const double before = power(lambda, ring_steps_);
    Seen seen;
    seen.grid = before * scaled(applied(window_, table.grid), Powers(lambda, steps_ - 1), count_);
    seen.outer.setZero();
    for (int i = 0; i < outer_count_; ++i) {
      seen.outer += before * table.outer[i] * on_outer_.col(i).array();
    }
    return seen;
  }

  void setMode(int mode, const Table& table) {
    const Seen seen = see(table, basis_.lambda_[mode]);
    mode_weights_.col(mode) = (seen.grid - seen.outer).head(count_);
  }

  /// Weights on the outer modes, then through W1^-1 on the outer points.
  void setOuterPoints() {
    OuterFunctionals on_outer_modes;
    for (int q = 0; q < outer_count_; ++q) {
      on_outer_modes.col(q) = scaled(applied(window_, tables_.outer[q].grid),
                                     Powers(outer_.lambda(q), steps_ - 1), count_);
    }
    on_outer_.leftCols(outer_count_) = on_outer_modes.leftCols(outer_count_) * outer_.inverse();
    outer_weights_ = on_outer_.topLeftCorner(count_, outer_count_);
  }

  /// The constant mode has weight 1 in the position and 0 in derivatives, less what the outer
  /// points hold of it.
  void setConstant() {
    mode_weights_.col(0) = -outer_weights_.rowwise().sum();
    mode_weights_(0, 0) += 1;
  }

  void setFixedModes() {
    for (int i = 0; i < basis_.fixedCount(); ++i) {
      setMode(1 + i, basis_.fixed(face_).tables[i]);
    }
  }

  void setSpokeModes() {
    for (int m = 1; m <= basis_.spokeCount(); ++m) {
      for (const bool plus : {true, false}) {
        Part part[2];
        const int parts_count = basis_.parts(m, plus, face_, part);
        if (parts_count == 0) {
          continue;
        }
        const double lambda = basis_.lambda_[part[0].mode];
        const int pair = basis_.pairIndex(m, plus);
        Functionals sine = Functionals::Zero(), cosine = Functionals::Zero();
        const Seen s = see(tables_.sine[pair], lambda);
        sine = s.grid - s.outer;
        if (!tables_.cosine.empty()) {
          const Seen c = see(tables_.cosine[pair], lambda);
          cosine = c.grid - c.outer;
        }
        for (int p = 0; p < parts_count; ++p) {
          mode_weights_.col(part[p].mode) =
              (part[p].cosine * cosine + part[p].sine * sine).head(count_);
        }
      }
    }
  }

  /// Those of a dart, but for the pair.
  void setSymmetricModes() {
    if (!basis_.dart_) {
      return;
    }
    const DartModes& dart = *basis_.dart_;
    for (int i = 0; i < dart.count(); ++i) {
      if (i != dart.pair().a && i != dart.pair().b) {
        setMode(basis_.firstSymmetric() + i, dart.table(i, face_));
      }
    }
  }

  /// Many steps make of each mode of a pair p times itself and q `feeds` times the other one.
  void setPair(const ModePair& pair) {
    const PairNumber ring = pairPower(pair, 1, ring_steps_);
    const PairNumber all = ring * pairPower(pair, 2, steps_ - 1);
    const Table tables[2] = {basis_.table(pair.a, face_), basis_.table(pair.b, face_)};
    const auto weights = [&](int own, double feeds) -> Functionals {
      Functionals result = Functionals::Zero();
      for (const int i : {own, 1 - own}) {
        const double factor = i == own ? 1 : feeds;
        const Powers powers(Powers::Scaled{factor * (i == own ? all.p : all.q)}, steps_ - 1);
        result += scaled(applied(window_, tables[i].grid), powers, count_);
        for (int c = 0; c < outer_count_; ++c) {
          result -=
              factor * (i == own ? ring.p : ring.q) * tables[i].outer[c] * on_outer_.col(c).array();
        }
      }
      return result;
    };
    mode_weights_.col(pair.a) = weights(0, pair.forth).head(count_);
    mode_weights_.col(pair.b) = weights(1, pair.back).head(count_);
  }

  /// The additional term of the Jordan form: (lambda + nilpotent)^n = lambda^n + n lambda^(n - 1)
  /// nilpotent.
  void addChain(const Chain& chain) {
    const double lambda = basis_.lambda_[chain.from];
    const Seen seen = see(basis_.table(chain.to, face_), lambda);
    const int all_steps = steps_ - 1 + ring_steps_;
    mode_weights_.col(chain.from) +=
        (chain.rate / lambda * (all_steps * seen.grid - ring_steps_ * seen.outer))
            .head(count_)
            .matrix();
  }

  void addFeedIntoOuterModes() {
    if (basis_.rest_mode_ < 0) {
      return;
    }
    const int mode = basis_.rest_mode_;
    const double lambda = basis_.lambda_[mode], before = power(lambda, ring_steps_);
    for (int q = 0; q < outer_count_; ++q) {
      const Powers fed(Powers::Scaled{scaledFeed(lambda, outer_.lambda(q), steps_ - 1)},
                       steps_ - 1);
      mode_weights_.col(mode) +=
          before * basis_.rest(face_, q) *
          scaled(applied(window_, tables_.outer[q].grid), fed, count_).head(count_).matrix();
    }
  }

  const Eigenbasis& basis_;
  const FaceTables& tables_;
  const OuterModes<double>& outer_;
  const int outer_count_, face_, steps_, ring_steps_;
  const GridWindow& window_;
  const int count_;
  Eigen::MatrixXd& mode_weights_;
  Eigen::MatrixXd& outer_weights_;
  OuterFunctionals on_outer_ = OuterFunctionals::Zero();  // weights on the outer points
};

void Eigenbasis::weights(int face, int steps, int ring_steps, const GridWindow& window,
                         Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& outer_weights) const {
  passBeforeLongSum(ring_);
  WindowWeights(*this, face, steps, ring_steps, window, mode_weights, outer_weights).compute();
}

}  // namespace limitsurf
