// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "limitsurf/uv/uv_border.h"
#include "limitsurf/uv/uv_map.h"

namespace limitsurf {

/// The borders of a map as straight pieces, each off its curve by no more than kMarginError / 2
/// texels, by rows of an image.
class BorderChords {
 public:
  /// `rows`: in a band of the image.
  BorderChords(const UvBorders& borders, const PlaneFrame& frame, const Lattice& image, int rows,
               double margin);

  struct Chord {
    Point2 begin, end;
    int curve;
    float from, to;  ///< of the curve
  };
  Span<Chord> inBand(std::size_t band) const {
    return Span<Chord>(chords_).subspan(begins_[band], begins_[band + 1] - begins_[band]);
  }
  const BorderCurve& curve(int index) const { return curves_[static_cast<std::size_t>(index)]; }
  double margin() const { return margin_; }

 private:
  void flatten(const Point2 points[4], int curve, double from, double to, const Box2& around,
               std::vector<Chord>& out) const;

  double margin_;
  std::vector<BorderCurve> curves_;
  std::vector<Chord> chords_;        // band after band; one that reaches several is in each
  std::vector<std::size_t> begins_;  // of each band, and one more
};

/// For the points of a lattice the nearest of all chords no farther away than the margin.
class NearestChords {
 public:
  NearestChords(const BorderChords& chords, const Lattice& lattice);

  /// `wanted(x, y)`: which points matter.
  template <typename Wanted>
  void add(const BorderChords::Chord& chord, const Wanted& wanted) {
    Box2 box;
    box.include(chord.begin);
    box.include(chord.end);
    const Lattice near =
        lattice_.within(box.grown(Point2::Constant(chords_.margin() + kMarginError)));
    const Point2 along = chord.end - chord.begin;
    const double squared = (along * along).sum();
    for (int y = near.y0; y <= near.y1; ++y) {
      const Lattice row = rowOf(chord, near, y);
      for (int x = row.x0; x <= row.x1; ++x) {
        if (wanted(x, y)) {
          const Point2 from = Point2(x, y) - chord.begin;
          const double part = squared > 0 ? std::clamp((from * along).sum() / squared, 0., 1.) : 0;
          const Point2 rest = from - part * along;
          Nearest& nearest = at(x, y);
          const double distance = (rest * rest).sum();
          if (distance < nearest.squared) {
            nearest.squared = distance;
            nearest.chord = &chord;
            nearest.part = part;
          }
        }
      }
    }
  }

  struct Foot {
    Location at;
    bool flipped;
  };
  /// Of the nearest chord's curve; false if there is none within the margin.
  bool foot(int x, int y, Foot& out) const;

 private:
  struct Nearest {
    double squared;
    double part = 0;
    const BorderChords::Chord* chord = nullptr;
  };
  Nearest& at(int x, int y) {
    return nearest_[static_cast<std::size_t>(y - lattice_.y0) * width_ +
                    static_cast<std::size_t>(x - lattice_.x0)];
  }
  Lattice rowOf(const BorderChords::Chord& chord, const Lattice& near, int y) const;

  const BorderChords& chords_;
  const Lattice lattice_;
  const std::size_t width_;
  std::vector<Nearest> nearest_;
};

}  // namespace limitsurf
