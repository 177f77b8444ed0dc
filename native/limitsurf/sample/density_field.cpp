// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/density_field.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The number of locations at which a function is read in one call.
constexpr std::size_t kBatch = std::size_t{1} << 16;

/// The square of a grid that a coordinate lies in, and the place within the square, 0 to 1.
struct GridPlace {
  GridPlace(double x, int side) {
    const double scaled = x * side;
    square = std::min(static_cast<int>(scaled), side - 1);
    part = scaled - square;
  }
  int square;
  double part;
};

double between(double a, double b, double part) { return (1 - part) * a + part * b; }

/// The lines of a grid between two coordinates, without those at the coordinates themselves.
struct GridLines {
  GridLines(double low, double high, int side)
      : first(static_cast<int>(std::floor(low * side)) + 1),
        last(static_cast<int>(std::ceil(high * side)) - 1) {}
  int first, last;
};

/// The mean between two coordinates of a function that is linear between the lines of a grid.
template <typename Function>
double meanBetween(double low, double high, int side, const Function& value) {
  const GridLines lines(low, high, side);
  const double at_low = value(low), at_high = value(high);
  if (lines.first > lines.last) {
    return (at_low + at_high) / 2;
  }
  double sum = 0, last = low, at_last = at_low;
  const auto advance = [&](double next, double at_next) {
    sum += (next - last) * (at_last + at_next) / 2;
    last = next;
    at_last = at_next;
  };
  for (int line = lines.first; line <= lines.last; ++line) {
    const double next = static_cast<double>(line) / side;
    advance(next, value(next));
  }
  advance(high, at_high);
  return sum / (high - low);
}

}  // namespace

DensityField::DensityField(const Density& density) {
  if (density.isConstant()) {
    return;
  }
  values_ = density.corners();
  levels_.assign(values_.size() / 4, 0);
  first_.resize(levels_.size());
  for (std::size_t face = 0; face < first_.size(); ++face) {
    first_[face] = 4 * face;
  }
  normalise();
  if (isZero()) {
    throw std::invalid_argument("density is 0 everywhere");
  }
}

DensityField::DensityField(const Density& density, const std::vector<int>& levels)
    : levels_(levels), first_(levels.size()) {
  std::size_t count = 0;
  for (std::size_t face = 0; face < levels.size(); ++face) {
    first_[face] = count;
    const std::size_t points = levels[face] < 0 ? 0 : (std::size_t{1} << levels[face]) + 1;
    count += points * points;
  }
  values_.reserve(count);
  std::vector<Location> at;
  at.reserve(kBatch);
  std::vector<std::size_t> places;  // of the values at these locations
  places.reserve(kBatch);
  const auto ask = [&] {
    const std::vector<double> weights = density.weights(at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      values_[places[i]] = weights[i];
    }
    at.clear();
    places.clear();
    InterruptionPoint::pass();
  };
  const DensityLimits& limits = density.limits();
  for (std::size_t face = 0; face < levels.size(); ++face) {
    const int side = levels[face] < 0 ? -1 : 1 << levels[face];
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x) {
        const Location place = {static_cast<int>(face), static_cast<double>(x) / side,
                                static_cast<double>(y) / side};
        values_.push_back(0);
        if (limits.areKnown() && limits.at(place) == 0) {
          continue;  // nothing else is possible there
        }
        at.push_back(place);
        places.push_back(values_.size() - 1);
        if (at.size() == kBatch) {
          ask();
        }
      }
    }
  }
  ask();
  normalise();
}

void DensityField::normalise() {
  largest_ = values_.empty() ? 0 : *std::max_element(values_.begin(), values_.end());
  if (!isZero()) {
    for (double& value : values_) {
      value /= largest_;
    }
  }
}

double DensityField::at(const Location& location) const {
  if (isConstant()) {
    return 1;
  }
  const int side = 1 << levels_[location.face];
  const GridPlace u(location.u, side), v(location.v, side);
  const double* row = grid(location.face) + v.square * (side + 1) + u.square;
  const double* next = row + side + 1;
  return between(between(row[0], row[1], u.part), between(next[0], next[1], u.part), v.part);
}

double DensityField::largestOn(const FaceRectangle& rectangle) const {
  if (isConstant()) {
    return 1;
  }
  const auto [u0, u1, v0, v1] = rectangle.extent();
  double largest = 0;
  for (const double v : {v0, v1}) {
    for (const double u : {u0, u1}) {
      largest = std::max(largest, at({rectangle.face, u, v}));
    }
  }
  // A bilinear function is largest at a corner. The corners here are those of the rectangle, the
  // points at which lines of the grid cross its sides, and the points of the grid inside it.
  const int side = 1 << levels_[rectangle.face];
  const GridLines columns(u0, u1, side), rows(v0, v1, side);
  for (int x = columns.first; x <= columns.last; ++x) {
    const double u = static_cast<double>(x) / side;
    largest = std::max({largest, at({rectangle.face, u, v0}), at({rectangle.face, u, v1})});
  }
  for (int y = rows.first; y <= rows.last; ++y) {
    const double v = static_cast<double>(y) / side;
    largest = std::max({largest, at({rectangle.face, u0, v}), at({rectangle.face, u1, v})});
    const double* row = grid(rectangle.face) + y * (side + 1);
    for (int x = columns.first; x <= columns.last; ++x) {
      largest = std::max(largest, row[x]);
    }
  }
  return largest;
}

double DensityField::meanOn(const FaceRectangle& rectangle) const {
  if (isConstant()) {
    return 1;
  }
  const FaceRectangle::Extent extent = rectangle.extent();
  const int side = 1 << levels_[rectangle.face];
  return meanBetween(extent.v0, extent.v1, side, [&](double v) {
    return meanBetween(extent.u0, extent.u1, side,
                       [&](double u) { return at({rectangle.face, u, v}); });
  });
}

}  // namespace limitsurf
