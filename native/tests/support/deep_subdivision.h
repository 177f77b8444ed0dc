// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "support/accuracy.h"
#include "support/cage.h"

namespace limitsurf::test {

/// The limit surface by nothing but subdivision: an independent witness of LimitSurface.
///
/// The faces around the location's face are refined by the rules of Catmull and Clark, written out
/// here from their definition, in floating point numbers of 50 decimal digits, down to a face whose
/// neighbourhood is a regular grid; there the surface is a bicubic B-spline. No eigenvalue, no
/// limit mask, nothing of the library. Refined neighbourhoods are kept, so that many locations near
/// the same vertex cost little more than one.
///
/// Knows: faces of any size, both boundary rules, both triangle rules, bow-tie vertices. Knows not:
/// sharpness, edges of three faces, irregular vertices themselves (but see cornerPosition()).
class DeepSubdivision {
 public:
  explicit DeepSubdivision(const Cage& cage);
  ~DeepSubdivision();

  /// All seven quantities, each the double nearest to the truth. Throws std::runtime_error exactly
  /// at irregular vertices. The normal is NaN where du x dv vanishes.
  Truth evaluate(const Location& at);

  /// The limit position of a face's corner, irregular or not: the vertex after so many levels that
  /// it moves no more.
  Vector3 cornerPosition(int face, int corner);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf::test
