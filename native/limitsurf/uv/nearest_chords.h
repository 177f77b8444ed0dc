// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "limitsurf/uv/border_chords.h"

namespace limitsurf {

/// For each point of a lattice the nearest chord that is no farther away than the margin.
class NearestChords {
 public:
  struct Nearest {
    double squared;
    double part = 0;
    const BorderChords::Chord* chord = nullptr;
  };

  /// `found` is overwritten. Its memory is the caller's, so that many lattices can share it.
  NearestChords(const BorderChords& chords, const Lattice& lattice, std::vector<Nearest>& found);

  /// Offers a chord to the points for which wanted(x, y) is true.
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

  /// A place on a border of the map.
  struct Foot {
    Location at;
    bool flipped;
  };
  /// Finds the nearest point on the nearest chord's curve. Returns false if none is within the
  /// margin.
  bool foot(int x, int y, Foot& out) const;

 private:
  Nearest& at(int x, int y) {
    return nearest_[static_cast<std::size_t>(y - lattice_.y0) * width_ +
                    static_cast<std::size_t>(x - lattice_.x0)];
  }
  /// The points of row y that a chord may be near to.
  Lattice rowOf(const BorderChords::Chord& chord, const Lattice& near, int y) const;

  const BorderChords& chords_;
  const Lattice lattice_;
  const std::size_t width_;
  std::vector<Nearest>& nearest_;
};

}  // namespace limitsurf
