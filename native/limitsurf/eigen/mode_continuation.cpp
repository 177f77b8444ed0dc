// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/mode_continuation.h"

namespace limitsurf {

const ModeContinuation::Outer& ModeContinuation::outer(Sides sides) {
  return outer_.try_emplace(sides, sides).first->second;
}

void ModeContinuation::stepGrid(const Outer& outer, const SlotValues& ring_values,
                                const SlotValues& next_ring, Wide& wide) {
  SlotValues values = ring_values;
  for (int i = 0; i < outer.count(); ++i) {
    values[outer.slots()[i]] = wide.outer[i];
  }
  wide.grid.fill(0);
  outer.step().apply(values, wide.grid);
  for (const int c : tile_grid::kRingSlots) {
    wide.grid[c] = next_ring[c];
  }
}

ModeContinuation::Wide ModeContinuation::continued(Sides sides, Real lambda,
                                                   const SlotValues& ring_values, Real feeds,
                                                   const Wide* fed) {
  const Outer& o = outer(sides);
  Outer::Vector rhs = Outer::Vector::Zero(o.count());
  if (fed) {
    rhs = feeds * fed->outer;
  }
  Wide wide;
  wide.outer = o.continuation(lambda, lambda, ring_values, rhs, wide.rest);
  SlotValues next{};
  for (const int c : tile_grid::kRingSlots) {
    // The fed vector's grid holds its ring times lambda.
    next[c] = lambda * ring_values[c] + (fed ? feeds * fed->grid[c] / lambda : 0);
  }
  stepGrid(o, ring_values, next, wide);
  return wide;
}

ModeContinuation::Wide ModeContinuation::continuedBeside(Sides sides, Real lambda, Real met,
                                                         const SlotValues& ring_values) {
  const Outer& o = outer(sides);
  Wide wide;
  wide.outer = o.continuation(lambda, met, ring_values, Outer::Vector::Zero(o.count()), wide.rest);
  SlotValues next{};
  for (const int c : tile_grid::kRingSlots) {
    next[c] = lambda * ring_values[c];
  }
  stepGrid(o, ring_values, next, wide);
  return wide;
}

std::array<ModeContinuation::Wide, 2> ModeContinuation::continuedPair(
    Sides sides, Real mean, Real forth, Real back, const std::array<SlotValues, 2>& ring_values) {
  const Outer& o = outer(sides);
  std::array<Outer::Vector, 2> right;
  for (int i = 0; i < 2; ++i) {
    right[i] = -(o.inverse() * o.fromRing(ring_values[i]));
  }
  // (S12 - mean) y_a - forth y_b = -S11 x_a and (S12 - mean) y_b - back y_a = -S11 x_b, mode by
  // mode of S12.
  std::array<Outer::Vector, 2> z = right;
  for (int q = 0; q < o.count(); ++q) {
    const Real d = o.lambda(q) - mean, determinant = d * d - forth * back;
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
    result[i].outer = o.vectors() * z[i];
    result[i].rest = Outer::Vector::Zero(o.count());
    stepGrid(o, ring_values[i], next, result[i]);
  }
  return result;
}

ModeContinuation::Wide ModeContinuation::linear(Sides sides, Real a, Real b) {
  const Outer& o = outer(sides);
  const auto value = [&](int c) {
    return a * static_cast<Real>(tile_grid::xOf(c)) + b * static_cast<Real>(tile_grid::yOf(c));
  };
  Wide wide;
  wide.outer.resize(o.count());
  wide.rest = Outer::Vector::Zero(o.count());
  for (int i = 0; i < o.count(); ++i) {
    wide.outer[i] = value(o.slots()[i]);
  }
  for (int c = 0; c < tile_grid::kSlots; ++c) {
    wide.grid[c] = tile_grid::exists(sides, c) ? value(c) / 2 : 0;
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
