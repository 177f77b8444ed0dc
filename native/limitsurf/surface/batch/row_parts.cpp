// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/row_parts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "limitsurf/surface/batch/patch_run.h"

namespace limitsurf {
namespace {

/// The exponent of a number that is not negative, 1023 for 1.
unsigned exponentOf(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return static_cast<unsigned>(bits >> 52) & 0x7ff;
}

/// The part of a ring tile in which (u, v) lies. Quarter finds the same steps, a and b.
unsigned quarterOf(double u, double v) {
  const unsigned of_u = exponentOf(u), of_v = exponentOf(v), larger = std::max(of_u, of_v);
  const unsigned steps = 1023 - larger + (larger == 1023 ? 1 : 0);
  const unsigned a = of_u + steps >= 1023 ? 1 : 0, b = of_v + steps >= 1023 ? 2 : 0;
  return steps <= RowParts::kMostSteps ? 4 * steps + a + b : RowParts::kDeep;
}

}  // namespace

void RowParts::reserve(unsigned count) {
  count_ = count;
  if (rows_.size() < count) {
    parameters_.resize(2 * (count + PatchRun::kReadBeyond));
    rows_.resize(count);
    part_.resize(2 * count);
  }
}

void RowParts::beginParts(unsigned last) {
  unsigned next = 0;
  for (unsigned part = 0; part <= last; ++part) {
    const unsigned count = std::exchange(end_[part], next);
    if (count > 0) {
      sorted()[next] = static_cast<std::uint8_t>(part);
    }
    next += count;
  }
}

void RowParts::sortByQuarterAfter(int steps, const TileRows& rows) {
  reserve(rows.count);
  const double bound = std::ldexp(1., -steps);
  kernels_->count(rows, bound, end_);
  beginParts(PartKernels::kParts - 1);
  kernels_->sort(rows, bound, end_, sortedRows());
}

void RowParts::sortByChild(const TileRows& rows) {
  reserve(rows.count);
  if (kernels_) {
    kernels_->count(rows, 0.5, end_);
    std::swap(end_[2], end_[3]);  // children are counted anticlockwise
    beginParts(3);
    unsigned next[PartKernels::kParts] = {end_[0], end_[1], end_[3], end_[2]};
    kernels_->sortByChild(rows, next, sortedRows());
    end_[0] = next[0];
    end_[1] = next[1];
    end_[2] = next[3];
    end_[3] = next[2];
    return;
  }
  const double *const u = rows.u, *const v = rows.v;
  std::uint8_t* const part = part_.data();
  std::fill_n(end_, 4, 0);
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned right = u[i] >= 0.5, top = v[i] >= 0.5;
    const unsigned child = right ^ (3 * top);  // anticlockwise
    part[i] = static_cast<std::uint8_t>(child);
    ++end_[child];
  }
  beginParts(3);
  // The child's parameters are distances from the edges at its corner. They change places in
  // children 1 and 3.
  const TileRows to_all = sortedRows();
  double* const along[2] = {to_all.u, to_all.v};
  std::size_t* const to_rows = to_all.rows;
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned child = part[i], is_turned = child & 1, to = end_[child]++;
    const int right = static_cast<int>((child ^ child >> 1) & 1);
    const int top = static_cast<int>(child >> 1);
    along[is_turned][to] = 2 * std::abs(right - u[i]);
    along[1 - is_turned][to] = 2 * std::abs(top - v[i]);
    to_rows[to] = rows.rows[i];
  }
}

void RowParts::sortByQuarter(const TileRows& rows, bool spokes_are_deep) {
  reserve(rows.count);
  const double *const u = rows.u, *const v = rows.v;
  std::uint8_t* const part = part_.data();
  static_assert(kParts <= 256);
  std::fill_n(end_, kParts, 0);
  unsigned last = 0;
  const unsigned on_spokes = spokes_are_deep ? 0 : ~0u;
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned is_inside = 0 - static_cast<unsigned>((u[i] != 0) & (v[i] != 0));
    const unsigned here = quarterOf(u[i], v[i]) & (is_inside | on_spokes);
    part[i] = static_cast<std::uint8_t>(here);
    last = std::max(last, here);
    ++end_[here];
  }
  beginParts(last);
  const TileRows to_all = sortedRows();
  double *const to_u = to_all.u, *const to_v = to_all.v;
  std::size_t* const to_rows = to_all.rows;
  for (unsigned i = 0; i < rows.count; ++i) {
    const std::uint8_t here = part[i];
    const unsigned to = end_[here]++;
    to_u[to] = u[i];
    to_v[to] = v[i];
    to_rows[to] = rows.rows[i];
  }
}

}  // namespace limitsurf
