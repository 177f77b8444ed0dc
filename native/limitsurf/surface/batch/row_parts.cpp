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
  if (part_.size() < count) {
    u_.resize(count + PatchRun::kReadBeyond);
    v_.resize(count + PatchRun::kReadBeyond);
    rows_.resize(count);
    part_.resize(count);
    sorted_.resize(count);
  }
}

void RowParts::beginParts(unsigned last) {
  unsigned next = 0;
  for (unsigned part = 0; part <= last; ++part) {
    next += std::exchange(end_[part], next);
  }
}

void RowParts::sortByChild(const TileRows& rows) {
  reserve(rows.count);
  const double *const u = rows.u, *const v = rows.v;
  std::uint8_t *const part = part_.data(), *const sorted = sorted_.data();
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
  double* const along[2] = {u_.data(), v_.data()};
  std::size_t* const to_rows = rows_.data();
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned child = part[i], is_turned = child & 1, to = end_[child]++;
    const int right = static_cast<int>((child ^ child >> 1) & 1);
    const int top = static_cast<int>(child >> 1);
    along[is_turned][to] = 2 * std::abs(right - u[i]);
    along[1 - is_turned][to] = 2 * std::abs(top - v[i]);
    to_rows[to] = rows.rows[i];
    sorted[to] = static_cast<std::uint8_t>(child);
  }
}

void RowParts::sortByQuarter(const TileRows& rows, bool spokes_are_deep) {
  reserve(rows.count);
  const double *const u = rows.u, *const v = rows.v;
  std::uint8_t *const part = part_.data(), *const sorted = sorted_.data();
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
  double *const to_u = u_.data(), *const to_v = v_.data();
  std::size_t* const to_rows = rows_.data();
  for (unsigned i = 0; i < rows.count; ++i) {
    const std::uint8_t here = part[i];
    const unsigned to = end_[here]++;
    to_u[to] = u[i];
    to_v[to] = v[i];
    to_rows[to] = rows.rows[i];
    sorted[to] = here;
  }
}

}  // namespace limitsurf
