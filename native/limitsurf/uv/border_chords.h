// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/interruption_point.h"
#include "limitsurf/uv/uv_borders.h"
#include "limitsurf/uv/uv_map.h"

namespace limitsurf {

/// The borders of a map as chords, which are at most kMarginError / 2 texels away from their
/// curves, sorted by bands of rows of an image.
class BorderChords {
 public:
  /// The foot of a texel on a chord may be this much farther away than the margin while that on the
  /// curve is within it, in texels.
  static constexpr double kSlack = kMarginError;

  /// `rows` is the height of a band, `margin` the distance from the borders that matters, in
  /// texels.
  BorderChords(const UvBorders& borders, const PlaneFrame& frame, const Lattice& image, int rows,
               double margin);

  struct Chord {
    Point2 begin, end;
    int curve;
    float from, to;  ///< the part of the curve
  };
  const Chord& chord(int index) const { return chords_[static_cast<std::size_t>(index)]; }
  /// The indices of the chords that reach a band.
  Span<int> inBand(std::size_t band) const {
    return Span<int>(by_band_).subspan(begins_[band], begins_[band + 1] - begins_[band]);
  }
  const BorderCurve& curve(int index) const { return curves_[static_cast<std::size_t>(index)]; }
  double margin() const { return margin_; }

 private:
  void flatten(const Point2 points[4], int curve, double from, double to, const Box2& around,
               InterruptionStride& stride);

  double margin_;
  std::vector<BorderCurve> curves_;
  std::vector<Chord> chords_;
  std::vector<int> by_band_;         // band after band; a chord stands in every band it reaches
  std::vector<std::size_t> begins_;  // where each band begins, and the end of the last
};

}  // namespace limitsurf
