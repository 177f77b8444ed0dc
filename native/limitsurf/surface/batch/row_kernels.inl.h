// SPDX-License-Identifier: Apache-2.0
//
// The inner loops for rows of which few lie on one patch. Their weights are found for several rows
// at once. Then they are evaluated one by one, all coordinates at a time. patch_kernels.inl.h
// includes this file.

/// Weights of a few rows along one axis, to be read row by row.
template <int kCount>
class StoredWeights {
 public:
  using Rows = Lanes<kCount>;

  /// At parameters t. If `low`, the rows for which `is_second` is not 1 have no first point.
  [[gnu::always_inline]] StoredWeights(const Rows& t, bool low, const Rows& is_second) {
    const BSplineWeights<Rows> inner(t, false, false);
    if (low) {
      const BSplineWeights<Rows> at_end(t, true, false);
      store(
          inner,
          [&](const Rows& a, const Rows& b) {
            return Rows::whereAtLeast(is_second, Rows::of(1), a, b);
          },
          at_end);
    } else {
      store(inner, [](const Rows& a, const Rows&) { return a; }, inner);
    }
  }

  struct Row {
    double value[4], first[3], second[2];
  };
  [[gnu::always_inline]] Row row(int i) const {
    return {{value_[0][i], value_[1][i], value_[2][i], value_[3][i]},
            {first_[0][i], first_[1][i], first_[2][i]},
            {second_[0][i], second_[1][i]}};
  }

 private:
  template <typename Choose>
  [[gnu::always_inline]] void store(const BSplineWeights<Rows>& a, const Choose& choose,
                                    const BSplineWeights<Rows>& b) {
    for (int i = 0; i < 4; ++i) {
      choose(a.value[i], b.value[i]).store(value_[i]);
    }
    for (int i = 0; i < 3; ++i) {
      choose(a.first[i], b.first[i]).store(first_[i]);
    }
    for (int i = 0; i < 2; ++i) {
      choose(a.second[i], b.second[i]).store(second_[i]);
    }
  }

  alignas(64) double value_[4][kCount], first_[3][kCount], second_[2][kCount];
};

/// The next `count` rows of a run, at most kCount. (Sorted by patch they would take longer:
/// branches on the number of a patch's rows are guessed wrong.)
template <int Order, int kCount, typename Real>
[[gnu::always_inline]] inline void evaluateGridRows(const GridRun& run, const Turned& turned,
                                                    std::size_t begin, int count,
                                                    const PatchResults<Real>& results) {
  using Rows = Lanes<kCount>;
  using Point = Lanes<4>;
  const Rows u = Rows::load(run.u + begin), v = Rows::load(run.v + begin);
  const Rows larger = Rows::larger(u, v), one = Rows::of(1), zero = Rows::of(0);
  // The steps until the row leaves the vertex's own quarter, as Quarter counts them.
  Rows scale = Rows::of(2), slot = zero;
  double bound = 0.5;
  for (int step = 1; step < run.steps; ++step, bound /= 2) {
    scale = Rows::whereAtLeast(larger, Rows::of(bound), scale, 2 * scale);
    slot = Rows::whereAtLeast(larger, Rows::of(bound), slot, slot + GridRun::kSlots);
  }
  const Rows scaled_u = scale * u, scaled_v = scale * v;
  const Rows a = Rows::whereAtLeast(scaled_u, one, one, zero);
  const Rows b = Rows::whereAtLeast(scaled_v, one, one, zero);
  const StoredWeights<kCount> weights_u(scaled_u - a, run.u_low, a);
  const StoredWeights<kCount> weights_v(scaled_v - b, run.v_low, b);
  alignas(64) double slots[kCount], first[kCount];
  (slot + GridRun::kStride * b + a).store(slots);
  (scale * run.depth_scale).store(first);

  const Point anchor = Point::load(run.anchor);
  const bool swapped = turned.swapped;
  const double sign_u = swapped ? turned.dv : turned.du, sign_v = swapped ? turned.du : turned.dv;
  Real* const along_u = swapped ? results.dv : results.du;
  Real* const along_v = swapped ? results.du : results.dv;
  for (int i = 0; i < count; ++i) {
    const double (*const points)[4] = run.grids + static_cast<std::ptrdiff_t>(slots[i]);
    PatchValues<Point> patch;
    evaluatePatch<Order, Point>(
        [&](int x, int y) { return Point::load(points[GridRun::kStride * y + x]); },
        weights_u.row(i), weights_v.row(i), patch);
    const std::size_t at = 3 * run.rows[begin + static_cast<std::size_t>(i)];
    putPoint(results.position + at, anchor + (patch.value + Point::of(0)));
    if (Order >= 1) {
      const Point du = patch.du * (sign_u * first[i]), dv = patch.dv * (sign_v * first[i]);
      putPoint(along_u + at, du);
      putPoint(along_v + at, dv);
      if (results.normal) {
        putNormal(swapped ? dv : du, swapped ? du : dv, run.normal_limits, results.normal + at);
      }
    }
    if (Order >= 2) {
      const double second = first[i] * first[i];
      putPoint((swapped ? results.dvv : results.duu) + at, patch.duu * second);
      putPoint(results.duv + at, patch.duv * (turned.duv * second));
      putPoint((swapped ? results.duu : results.dvv) + at, patch.dvv * second);
    }
  }
}

template <int Order, typename Real>
void evaluateOnGrids(const GridRun& run, const PatchResults<Real>& results) {
  const Turned turned(run.turns, 1, 1);
  for (std::size_t begin = 0; begin < run.count; begin += kLanes) {
    const std::size_t left = run.count - begin;
    evaluateGridRows<Order, kLanes>(run, turned, begin,
                                    left < kLanes ? static_cast<int>(left) : kLanes, results);
  }
}

/// The next `count` rows of a run, at most kCount.
template <int Order, int kCount, typename Real>
[[gnu::always_inline]] inline void evaluateSingleRows(const SingleRun& run, std::size_t begin,
                                                      int count,
                                                      const PatchResults<Real>& results) {
  using Point = Lanes<4>;
  using Rows = Lanes<kCount>;
  const StoredWeights<kCount> weights_u(Rows::load(run.u + begin), false, Rows::of(0));
  const StoredWeights<kCount> weights_v(Rows::load(run.v + begin), false, Rows::of(0));
  for (int i = 0; i < count; ++i) {
    const std::size_t place = begin + static_cast<std::size_t>(i);
    const int* const indices = run.indices[place];
    const Point anchor = Point::load(run.points[indices[SingleRun::kAnchor]]);
    PatchValues<Point> patch;
    evaluatePatch<Order, Point>(
        [&](int x, int y) { return Point::load(run.points[indices[4 * y + x]]) - anchor; },
        weights_u.row(i), weights_v.row(i), patch);
    const std::size_t at = 3 * run.rows[place];
    putPoint(results.position + at, anchor + (patch.value + Point::of(0)));
    if (Order >= 1) {
      putPoint(results.du + at, patch.du);
      putPoint(results.dv + at, patch.dv);
      if (results.normal) {
        putNormal(patch.du, patch.dv, run.normal_limits, results.normal + at);
      }
    }
    if (Order >= 2) {
      putPoint(results.duu + at, patch.duu);
      putPoint(results.duv + at, patch.duv);
      putPoint(results.dvv + at, patch.dvv);
    }
  }
}

template <int Order, typename Real>
void evaluateSingles(const SingleRun& run, const PatchResults<Real>& results) {
  for (std::size_t begin = 0; begin < run.count; begin += kLanes) {
    const std::size_t left = run.count - begin;
    evaluateSingleRows<Order, kLanes>(run, begin, left < kLanes ? static_cast<int>(left) : kLanes,
                                      results);
  }
}
