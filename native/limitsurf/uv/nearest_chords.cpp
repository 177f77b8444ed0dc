// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/nearest_chords.h"

#include <cmath>
#include <limits>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {
namespace {

/// Newton's iteration doubles its digits with each step; it ends as soon as the distance no longer
/// falls, and after this many steps at the latest.
constexpr int kMostSteps = 20;

double squaredNorm(const Point2& vector) { return (vector * vector).sum(); }

}  // namespace

NearestChords::NearestChords(const BorderChords& chords, const Lattice& lattice,
                             std::vector<Nearest>& found)
    : chords_(chords),
      lattice_(lattice),
      width_(static_cast<std::size_t>(lattice.x1 - lattice.x0 + 1)),
      nearest_(found) {
  const double farthest = chords.margin() + BorderChords::kSlack;
  nearest_.assign(width_ * static_cast<std::size_t>(lattice.y1 - lattice.y0 + 1),
                  Nearest{farthest * farthest});
}

Lattice NearestChords::rowOf(const BorderChords::Chord& chord, const Lattice& near, int y) const {
  const double margin = chords_.margin() + BorderChords::kSlack;
  const Point2 along = chord.end - chord.begin;
  double from = 0, to = 1;
  if (along[1] != 0) {
    const double a = (y - margin - chord.begin[1]) / along[1];
    const double b = (y + margin - chord.begin[1]) / along[1];
    from = std::clamp(std::min(a, b), 0., 1.);
    to = std::clamp(std::max(a, b), 0., 1.);
  }
  Box2 part;
  part.include({chord.begin[0] + from * along[0], y});
  part.include({chord.begin[0] + to * along[0], y});
  return Lattice{near.x0, y, near.x1, y}.within(part.grown({margin, 0}));
}

bool NearestChords::foot(int x, int y, Foot& out) const {
  const Nearest& nearest = nearest_[static_cast<std::size_t>(y - lattice_.y0) * width_ +
                                    static_cast<std::size_t>(x - lattice_.x0)];
  if (!nearest.chord) {
    return false;
  }
  const BorderCurve& curve = chords_.curve(nearest.chord->curve);
  const Point2 target(x, y);
  const Point2* p = curve.points;
  double t = nearest.chord->from + nearest.part * (nearest.chord->to - nearest.chord->from);
  double best = std::numeric_limits<double>::infinity(), best_t = t;
  for (int step = 0; step < kMostSteps; ++step) {
    Point2 value, first, second;
    bezier::cubic<2>(p[0], p[1], p[2], p[3], t, value, first, second);
    const Point2 rest = value - target;
    const double squared = squaredNorm(rest);
    if (!(squared < best)) {
      break;
    }
    best = squared;
    best_t = t;
    const double slope = (rest * first).sum();
    const double bend = squaredNorm(first) + (rest * second).sum();
    const double scale = bend > 0 ? bend : squaredNorm(first);
    if (!(scale > 0)) {
      break;
    }
    t = std::clamp(t - slope / scale, 0., 1.);
  }
  if (!(std::sqrt(best) <= chords_.margin())) {
    return false;
  }
  out = {curve.at(best_t), curve.flipped};
  return true;
}

}  // namespace limitsurf
