// SPDX-License-Identifier: Apache-2.0
//
// The inner loops for rows whose weights are given. patch_kernels.inl.h includes this file.

/// Positions: two sums of every other point each, because additions wait for each other.
template <typename Real>
[[gnu::always_inline]] inline void putWeighted0(const double (*points)[4], const int* indices,
                                                const double* weights, std::size_t count,
                                                std::size_t at, const PatchResults<Real>& results) {
  using Point = Lanes<4>;
  const Point anchor = Point::load(points[indices[0]]);
  Point even = Point::of(0), odd = even;
  std::size_t j = 0;
  for (; j + 2 <= count; j += 2) {
    even = even + (Point::load(points[indices[j + 1]]) - anchor) * weights[j];
    odd = odd + (Point::load(points[indices[j + 2]]) - anchor) * weights[j + 1];
  }
  if (j < count) {
    even = even + (Point::load(points[indices[j + 1]]) - anchor) * weights[j];
  }
  putPoint(results.position + at, anchor + (even + odd));
}

template <typename Real>
[[gnu::always_inline]] inline void putWeighted1(const double (*points)[4], const int* indices,
                                                const double* weights, std::size_t count,
                                                std::size_t at, const PatchResults<Real>& results) {
  using Point = Lanes<4>;
  const Point anchor = Point::load(points[indices[0]]);
  Point value = Point::of(0), du = value, dv = value;
  for (std::size_t j = 0; j < count; ++j) {
    const Point point = Point::load(points[indices[j + 1]]) - anchor;
    value = value + point * weights[3 * j];
    du = du + point * weights[3 * j + 1];
    dv = dv + point * weights[3 * j + 2];
  }
  putPoint(results.position + at, anchor + value);
  putPoint(results.du + at, du);
  putPoint(results.dv + at, dv);
}

template <int Order, typename Real>
void evaluateWeighted(const WeightedRun& run, const PatchResults<Real>& results) {
  constexpr std::size_t kKinds = Order == 0 ? 1 : 3;
  for (std::size_t i = 0; i < run.count; ++i) {
    const std::size_t begin = run.offsets[i], count = run.offsets[i + 1] - begin - 1;
    const int* const indices = run.indices + begin;
    const double* const weights = run.weights + kKinds * (begin - run.first - i);
    const std::size_t at = 3 * run.rows[i];
    if (Order == 0) {
      putWeighted0(run.points, indices, weights, count, at, results);
    } else {
      putWeighted1(run.points, indices, weights, count, at, results);
    }
  }
}
