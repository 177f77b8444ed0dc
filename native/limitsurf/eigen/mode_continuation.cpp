// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/mode_continuation.h"

#include "limitsurf/precision/sum_of_products.h"

namespace limitsurf {
namespace {

template <Sides sides>
const ModeContinuation& shared() {
  static const ModeContinuation continuation(sides);
  return continuation;
}

constexpr int kRingSlotCount = static_cast<int>(tile_grid::kRingSlots.size());

}  // namespace

const ModeContinuation& ModeContinuation::of(Sides sides) {
  switch (sides) {
    case Sides::inner:
      return shared<Sides::inner>();
    case Sides::left:
      return shared<Sides::left>();
    case Sides::right:
      return shared<Sides::right>();
    default:
      return shared<Sides::both>();
  }
}

ModeContinuation::ModeContinuation(Sides sides) : outer_(sides) {
  from_ring_.resize(outer_.count(), kRingSlotCount);
  for (int i = 0; i < kRingSlotCount; ++i) {
    from_ring_.col(i) = outer_.inverse() * outer_.s11().col(tile_grid::kRingSlots[i]);
  }
}

void ModeContinuation::stepGrid(const SlotValues& ring_values, const SlotValues& next_ring,
                                Wide& wide) const {
  SlotValues values = ring_values;
  for (int i = 0; i < outer_.count(); ++i) {
    values[outer_.slots()[i]] = wide.outer[i];
  }
  wide.grid.fill(0);
  const TileStep<Real>& step = outer_.step();
  for (const auto& row : step.rows()) {
    SumOfProducts sum;
    for (std::size_t i = row.first; i < row.end; ++i) {
      // Weights are multiples of 1/64.
      sum.add(values[step.term(i).slot], step.term(i).weight.high());
    }
    wide.grid[row.slot] = sum.sum();
  }
  for (const int c : tile_grid::kRingSlots) {
    wide.grid[c] = next_ring[c];
  }
}

ModeContinuation::Vector ModeContinuation::fromRing(const SlotValues& ring_values) const {
  Vector result(outer_.count());
  for (int q = 0; q < outer_.count(); ++q) {
    SumOfProducts sum;
    for (int i = 0; i < kRingSlotCount; ++i) {
      sum.add(from_ring_(q, i), ring_values[tile_grid::kRingSlots[i]]);
    }
    result[q] = -sum.sum();
  }
  return result;
}

ModeContinuation::Vector ModeContinuation::outerPart(const Vector& z) const {
  Vector result(outer_.count());
  for (int i = 0; i < outer_.count(); ++i) {
    SumOfProducts sum;
    for (int q = 0; q < outer_.count(); ++q) {
      sum.add(outer_.vectors()(i, q), z[q]);
    }
    result[i] = sum.sum();
  }
  return result;
}

void ModeContinuation::solveOuter(Real lambda, Real met, const Vector& right, Wide& wide) const {
  Vector z = Vector::Zero(outer_.count());
  wide.rest = Vector::Zero(outer_.count());
  for (int q = 0; q < outer_.count(); ++q) {
    if (outer_.lambda(q) == met) {
      wide.rest[q] = -right[q];
    } else {
      z[q] = right[q] / (outer_.lambda(q) - lambda);
    }
  }
  wide.outer = outerPart(z);
}

ModeContinuation::Wide ModeContinuation::continued(Real lambda, const SlotValues& ring_values,
                                                   Real feeds, const Wide* fed) const {
  Vector right = fromRing(ring_values);
  if (fed) {
    right += outer_.inverse() * (feeds * fed->outer);
  }
  Wide wide;
  solveOuter(lambda, lambda, right, wide);
  SlotValues next{};
  for (const int c : tile_grid::kRingSlots) {
    // The fed vector's grid holds its ring times lambda.
    next[c] = lambda * ring_values[c] + (fed ? feeds * fed->grid[c] / lambda : 0);
  }
  stepGrid(ring_values, next, wide);
  return wide;
}

ModeContinuation::Wide ModeContinuation::continuedBeside(Real lambda, Real met,
                                                         const SlotValues& ring_values) const {
  Wide wide;
  solveOuter(lambda, met, fromRing(ring_values), wide);
  SlotValues next{};
  for (const int c : tile_grid::kRingSlots) {
    next[c] = lambda * ring_values[c];
  }
  stepGrid(ring_values, next, wide);
  return wide;
}

std::array<ModeContinuation::Wide, 2> ModeContinuation::continuedPair(
    Real mean, Real forth, Real back, const std::array<SlotValues, 2>& ring_values) const {
  const std::array<Vector, 2> right = {fromRing(ring_values[0]), fromRing(ring_values[1])};
  // (S12 - mean) y_a - forth y_b = -S11 x_a and (S12 - mean) y_b - back y_a = -S11 x_b, mode by
  // mode of S12.
  std::array<Vector, 2> z = right;
  for (int q = 0; q < outer_.count(); ++q) {
    const Real d = outer_.lambda(q) - mean, determinant = d * d - forth * back;
    z[0][q] = (d * right[0][q] + forth * right[1][q]) / determinant;
    z[1][q] = (d * right[1][q] + back * right[0][q]) / determinant;
  }
  std::array<Wide, 2> result;
  for (int i = 0; i < 2; ++i) {
    const Real feeds = i == 0 ? forth : back;
    SlotValues next{};
    for (const int c : tile_grid::kRingSlots) {
      next[c] = mean * ring_values[i][c] + feeds * ring_values[1 - i][c];
    }
    result[i].outer = outerPart(z[i]);
    result[i].rest = Vector::Zero(outer_.count());
    stepGrid(ring_values[i], next, result[i]);
  }
  return result;
}

ModeContinuation::Wide ModeContinuation::linear(Real a, Real b) const {
  const auto value = [&](int c) { return a * tile_grid::xOf(c) + b * tile_grid::yOf(c); };
  Wide wide;
  wide.outer.resize(outer_.count());
  wide.rest = Vector::Zero(outer_.count());
  for (int i = 0; i < outer_.count(); ++i) {
    wide.outer[i] = value(outer_.slots()[i]);
  }
  for (int c = 0; c < tile_grid::kSlots; ++c) {
    wide.grid[c] = tile_grid::exists(outer_.sides(), c) ? value(c) / 2 : 0;
  }
  return wide;
}

ModeTable ModeContinuation::rounded(const Wide& wide) {
  ModeTable table;
  for (Eigen::Index i = 0; i < wide.outer.size(); ++i) {
    table.outer[i] = static_cast<double>(wide.outer[i]);
  }
  for (int c = 0; c < tile_grid::kSlots; ++c) {
    table.grid[c] = static_cast<double>(wide.grid[c]);
  }
  return table;
}

}  // namespace limitsurf
