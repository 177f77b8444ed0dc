// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/border_chords.h"

#include <algorithm>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {
namespace {

/// The largest distance of a chord from its curve, in texels.
constexpr double kChordError = kMarginError / 2;
/// A part of a curve shorter than this in its parameter counts as straight, whatever its points
/// are.
constexpr double kShortestPart = 1e-6;

double squaredNorm(const Point2& vector) { return (vector * vector).sum(); }

}  // namespace

BorderChords::BorderChords(const UvBorders& borders, const PlaneFrame& frame, const Lattice& image,
                           int rows, double margin)
    : margin_(margin) {
  const Box2 box{Point2(image.x0, image.y0), Point2(image.x1, image.y1)};
  borders.appendCurves(frame, box, margin, kMarginError, curves_);
  const Box2 around = box.grown(Point2::Constant(margin + BorderChords::kSlack));
  InterruptionStride stride;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    flatten(curves_[i].points, static_cast<int>(i), 0, 1, around, stride);
  }
  const auto forEachBand = [&](const auto& body) {
    for (std::size_t i = 0; i < chords_.size(); ++i) {
      stride.step();
      Box2 chord_box;
      chord_box.include(chords_[i].begin);
      chord_box.include(chords_[i].end);
      const Lattice near =
          image.within(chord_box.grown(Point2::Constant(margin + BorderChords::kSlack)));
      if (!near.empty()) {
        for (int band = near.y0 / rows; band <= near.y1 / rows; ++band) {
          body(static_cast<int>(i), static_cast<std::size_t>(band));
        }
      }
    }
  };
  begins_.assign(static_cast<std::size_t>((image.y1 + rows) / rows) + 2, 0);
  forEachBand([&](int, std::size_t band) { ++begins_[band + 2]; });
  for (std::size_t band = 2; band < begins_.size(); ++band) {
    begins_[band] += begins_[band - 1];
  }
  by_band_.resize(begins_.back());
  forEachBand([&](int chord, std::size_t band) { by_band_[begins_[band + 1]++] = chord; });
}

void BorderChords::flatten(const Point2 points[4], int curve, double from, double to,
                           const Box2& around, InterruptionStride& stride) {
  stride.step();
  Box2 box;
  for (int i = 0; i < 4; ++i) {
    box.include(points[i]);
  }
  if ((box.high < around.low).any() || (box.low > around.high).any()) {
    return;
  }
  // The distance of a chord from its curve is at most an eighth of the second derivative, which is
  // at most six times the largest second difference: 0.75 of that, of which 0.5625 is the square.
  const double bend = std::max(squaredNorm(points[0] - 2 * points[1] + points[2]),
                               squaredNorm(points[1] - 2 * points[2] + points[3]));
  if (!(0.5625 * bend > kChordError * kChordError) || to - from < kShortestPart) {
    chords_.push_back(
        {points[0], points[3], curve, static_cast<float>(from), static_cast<float>(to)});
    return;
  }
  Point2 half[4];
  const double middle = 0.5 * (from + to);
  std::copy(points, points + 4, half);
  bezier::cut(half, 1, 0, 0.5);
  flatten(half, curve, from, middle, around, stride);
  std::copy(points, points + 4, half);
  bezier::cut(half, 1, 0.5, 1);
  flatten(half, curve, middle, to, around, stride);
}

}  // namespace limitsurf
