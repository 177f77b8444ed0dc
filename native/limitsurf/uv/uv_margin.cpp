// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_margin.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {
namespace {

/// What a chord may be off its curve.
constexpr double kFlat = kMarginError / 2;

/// How far beyond the margin a foot on the chord may be so that the one on the curve is not.
constexpr double kSlack = kMarginError;

double squaredNorm(const Point2& vector) { return (vector * vector).sum(); }

}  // namespace

BorderChords::BorderChords(const UvBorders& borders, const PlaneFrame& frame, const Lattice& image,
                           int rows, double margin)
    : margin_(margin) {
  const Box2 box{Point2(image.x0, image.y0), Point2(image.x1, image.y1)};
  borders.appendCurves(frame, box, margin, kMarginError, curves_);
  const Box2 around = box.grown(Point2::Constant(margin + kSlack));
  std::vector<Chord> all;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    flatten(curves_[i].points, static_cast<int>(i), 0, 1, around, all);
  }
  const auto forEachBand = [&](const auto& body) {
    for (const Chord& chord : all) {
      Box2 chord_box;
      chord_box.include(chord.begin);
      chord_box.include(chord.end);
      const Lattice near = image.within(chord_box.grown(Point2::Constant(margin + kSlack)));
      if (!near.empty()) {
        for (int band = near.y0 / rows; band <= near.y1 / rows; ++band) {
          body(chord, static_cast<std::size_t>(band));
        }
      }
    }
  };
  begins_.assign(static_cast<std::size_t>((image.y1 + rows) / rows) + 2, 0);
  forEachBand([&](const Chord&, std::size_t band) { ++begins_[band + 2]; });
  for (std::size_t band = 2; band < begins_.size(); ++band) {
    begins_[band] += begins_[band - 1];
  }
  chords_.resize(begins_.back());
  forEachBand([&](const Chord& chord, std::size_t band) { chords_[begins_[band + 1]++] = chord; });
}

void BorderChords::flatten(const Point2 points[4], int curve, double from, double to,
                           const Box2& around, std::vector<Chord>& out) const {
  Box2 box;
  for (int i = 0; i < 4; ++i) {
    box.include(points[i]);
  }
  if ((box.high < around.low).any() || (box.low > around.high).any()) {
    return;
  }
  // A chord is off by an eighth of the second derivative, six times the largest second difference.
  const double bend = std::max(squaredNorm(points[0] - 2 * points[1] + points[2]),
                               squaredNorm(points[1] - 2 * points[2] + points[3]));
  if (!(0.5625 * bend > kFlat * kFlat) || to - from < 1e-6) {
    out.push_back({points[0], points[3], curve, static_cast<float>(from), static_cast<float>(to)});
    return;
  }
  Point2 half[4];
  const double middle = 0.5 * (from + to);
  std::copy(points, points + 4, half);
  bezier::cut(half, 1, 0, 0.5);
  flatten(half, curve, from, middle, around, out);
  std::copy(points, points + 4, half);
  bezier::cut(half, 1, 0.5, 1);
  flatten(half, curve, middle, to, around, out);
}

NearestChords::NearestChords(const BorderChords& chords, const Lattice& lattice)
    : chords_(chords),
      lattice_(lattice),
      width_(static_cast<std::size_t>(lattice.x1 - lattice.x0 + 1)),
      nearest_(width_ * static_cast<std::size_t>(lattice.y1 - lattice.y0 + 1)) {
  const double farthest = chords.margin() + kSlack;
  for (Nearest& nearest : nearest_) {
    nearest.squared = farthest * farthest;
  }
}

Lattice NearestChords::rowOf(const BorderChords::Chord& chord, const Lattice& near, int y) const {
  const double margin = chords_.margin() + kSlack;
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
  for (int step = 0; step < 20; ++step) {
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
