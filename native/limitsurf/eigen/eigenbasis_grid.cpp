// SPDX-License-Identifier: Apache-2.0
//
// From the coefficients of the modes to a face's control points after any number of steps: the sum
// over modes of section 3.2 of Lacewell & Burley 2007, with the term of its Jordan pair.
#include <algorithm>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/large_ring.h"
#include "limitsurf/eigen/mode_powers.h"

namespace limitsurf {
namespace {

Eigen::Array4d padded(const Points& points, int row) {
  return {points(row, 0), points(row, 1), points(row, 2), 0};
}

}  // namespace

/// Adds up the control points of one face after some steps, or their nets, mode by mode.
class Eigenbasis::GridSum {
 public:
  GridSum(const Eigenbasis& basis, int face, int steps, int ring_steps, const Points& coefficients,
          const Eigen::Array4d outer_points[], const derivative_nets::Selection* selection,
          Eigen::Array4d sums[])
      : basis_(basis),
        tables_(basis.tables(basis.sides(face))),
        outer_(tables_.outer_modes),
        outer_count_(outer_.count()),
        face_(face),
        steps_(steps),
        ring_steps_(ring_steps),
        coefficients_(coefficients),
        selection_(selection),
        sums_(sums) {
    std::fill_n(sums_, selection ? derivative_nets::kCount : tile_grid::kSlots,
                Eigen::Array4d::Zero());
    std::copy_n(outer_points, outer_count_, left_over_);
  }

  void compute() {
    subtractConstant();
    addFixedModes();
    addSpokeModes();
    addSymmetricModes();
    for (const Chain& chain : basis_.chains_) {
      addChain(chain);
    }
    for (const ModePair& pair : basis_.pairs_) {
      addPair(pair);
    }
    addOuterModes();
  }

 private:
  Eigen::Array4d coefficient(int mode) const { return padded(coefficients_, mode); }

  void addGrid(const Table& table, const Eigen::Array4d& coefficient) {
    if (selection_) {
      double nets[derivative_nets::kCount];
      derivative_nets::form(table.grid, nets);
      for (const int i : *selection_) {
        sums_[i] += nets[i] * coefficient;
      }
    } else {
      for (int c = 0; c < tile_grid::kSlots; ++c) {
        sums_[c] += table.grid[c] * coefficient;
      }
    }
  }

  /// Adds a mode's table to the grid, and subtracts what the mode holds of the outer points.
  void add(const Table& table, const Eigen::Array4d& in_grid, const Eigen::Array4d& in_outer) {
    addGrid(table, in_grid);
    for (int i = 0; i < outer_count_; ++i) {
      left_over_[i] -= table.outer[i] * in_outer;
    }
  }

  /// A mode that a step multiplies by lambda, and that feeds no mode of the ring.
  void addMode(const Table& table, double lambda, const Eigen::Array4d& coefficient) {
    const Eigen::Array4d before = power(lambda, ring_steps_) * coefficient;
    add(table, power(2 * lambda, steps_ - 1) * before, before);
  }

  /// The grid holds no constant mode, but the outer points do.
  void subtractConstant() {
    const Eigen::Array4d constant = coefficient(0);
    for (int i = 0; i < outer_count_; ++i) {
      left_over_[i] -= constant;
    }
  }

  void addFixedModes() {
    for (int i = 0; i < basis_.fixedCount(); ++i) {
      addMode(basis_.fixed(face_).tables[i], basis_.lambda_[1 + i], coefficient(1 + i));
    }
  }

  void addSpokeModes() {
    for (int m = 1; m <= basis_.spokeCount(); ++m) {
      for (const bool plus : {true, false}) {
        Part part[2];
        const int count = basis_.parts(m, plus, face_, part);
        if (count == 0) {
          continue;
        }
        Eigen::Array4d cosine = Eigen::Array4d::Zero(), sine = cosine;
        for (int p = 0; p < count; ++p) {
          cosine += part[p].cosine * coefficient(part[p].mode);
          sine += part[p].sine * coefficient(part[p].mode);
        }
        const double lambda = basis_.lambda_[part[0].mode];
        const int pair = basis_.pairIndex(m, plus);
        addMode(tables_.sine[pair], lambda, sine);
        if (!tables_.cosine.empty()) {
          addMode(tables_.cosine[pair], lambda, cosine);
        }
      }
    }
  }

  void addSymmetricModes() {
    if (!basis_.dart_) {
      return;
    }
    const DartModes& dart = *basis_.dart_;
    for (int i = 0; i < dart.count(); ++i) {
      if (i != dart.pair().a && i != dart.pair().b) {
        const int mode = basis_.firstSymmetric() + i;
        addMode(dart.table(i, face_), basis_.lambda_[mode], coefficient(mode));
      }
    }
  }

  /// The additional term of the Jordan form: (n - 1) lambda^(n - 2) of the mode that is fed.
  void addChain(const Chain& chain) {
    const double lambda = basis_.lambda_[chain.from];
    const Eigen::Array4d fed =
        power(lambda, ring_steps_) * chain.rate / lambda * coefficient(chain.from);
    add(basis_.table(chain.to, face_),
        (steps_ - 1 + ring_steps_) * power(2 * lambda, steps_ - 1) * fed, ring_steps_ * fed);
  }

  void addPair(const ModePair& pair) {
    const PairNumber ring = pairPower(pair, 1, ring_steps_);
    const PairNumber all = ring * pairPower(pair, 2, steps_ - 1);
    const Eigen::Array4d a = coefficient(pair.a), b = coefficient(pair.b);
    add(basis_.table(pair.a, face_), all.p * a + all.q * pair.back * b,
        ring.p * a + ring.q * pair.back * b);
    add(basis_.table(pair.b, face_), all.p * b + all.q * pair.forth * a,
        ring.p * b + ring.q * pair.forth * a);
  }

  /// What the ring's modes have left over of the outer points belongs to the outer modes.
  void addOuterModes() {
    for (int q = 0; q < outer_count_; ++q) {
      Eigen::Array4d sum = Eigen::Array4d::Zero();
      for (int i = 0; i < outer_count_; ++i) {
        sum += outer_.inverse()(q, i) * left_over_[i];
      }
      sum *= power(2 * outer_.lambda(q), steps_ - 1);
      if (basis_.rest_mode_ >= 0) {
        const double lambda = basis_.lambda_[basis_.rest_mode_];
        sum += scaledFeed(lambda, outer_.lambda(q), steps_ - 1) * basis_.rest(face_, q) *
               power(lambda, ring_steps_) * coefficient(basis_.rest_mode_);
      }
      addGrid(tables_.outer[q], sum);
    }
  }

  const Eigenbasis& basis_;
  const FaceTables& tables_;
  const OuterModes<double>& outer_;
  const int outer_count_, face_, steps_, ring_steps_;
  const Points& coefficients_;
  const derivative_nets::Selection* const selection_;  // of nets; null for the points alone
  Eigen::Array4d* const sums_;
  Eigen::Array4d left_over_[tile_grid::kOuter];  // of the outer points, without the ring's modes
};

void Eigenbasis::controlGrid(int face, int steps, int ring_steps, const Points& coefficients,
                             const Eigen::Array4d outer_points[], Eigen::Array4d grid[]) const {
  passBeforeLongSum(ring_);
  GridSum(*this, face, steps, ring_steps, coefficients, outer_points, nullptr, grid).compute();
}

void Eigenbasis::derivativeNets(int face, int steps, int ring_steps, const Points& coefficients,
                                const Eigen::Array4d outer_points[],
                                const derivative_nets::Selection& selection,
                                Eigen::Array4d nets[]) const {
  passBeforeLongSum(ring_);
  GridSum(*this, face, steps, ring_steps, coefficients, outer_points, &selection, nets).compute();
}

}  // namespace limitsurf
