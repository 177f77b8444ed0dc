// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "support/cages/cage.h"
#include "support/truth/accuracy.h"

namespace limitsurf::test {

/// Curvature at a place, each number the double nearest to the truth.
struct TrueCurvature {
  double k1, k2, mean, gaussian;
  Vector3 direction1;  ///< along which the surface bends by k1, either way round
  double area;         ///< |du x dv|
};

/// The limit surface by subdivision alone: an independent witness for LimitSurface.
///
/// The faces around the location's face are refined by the rules of Catmull and Clark and of
/// OpenSubdiv's sharpness, written out here from their definition, in floating point numbers of 50
/// decimal digits (sharpness itself in float32, as OpenSubdiv has it), down to a face whose
/// neighbourhood is a regular grid; there the surface is a bicubic B-spline. It uses no
/// eigenvalues, no limit masks, and no code of the library, of Sdc or of Far. Refined
/// neighbourhoods are kept, so that many locations near the same vertex cost little more than one.
///
/// It supports faces of any size, both boundary rules, both triangle rules, both kinds of creasing,
/// any sharpness, edges of any number of faces and windings, vertices of several fans. It supports
/// neither faces that use a vertex twice nor the bilinear scheme.
class DeepSubdivision {
 public:
  explicit DeepSubdivision(const Cage& cage);
  ~DeepSubdivision();

  /// All seven quantities, each the double nearest to the truth. Throws std::runtime_error exactly
  /// at irregular vertices. The normal is NaN where du x dv vanishes.
  Truth evaluate(const Location& at);

  /// Curvature by the textbook formulas, in the same numbers of 50 digits: unlike what the rounded
  /// derivatives of evaluate() would give, it keeps all digits beside irregular vertices. NaN where
  /// du x dv vanishes. Throws std::runtime_error exactly at irregular vertices.
  TrueCurvature curvature(const Location& at);

  /// The quantities at a face's corner that is an irregular vertex. The position is that of the
  /// vertex after so many levels that it does not move any more. Along infinitely sharp edges that
  /// bound a sector, du, dv, duu and dvv are those of the crease curve, which is a B-spline; around
  /// two and three smooth faces du = dv = 0. All others are NaN.
  Truth corner(int face, int corner);
  Vector3 cornerPosition(int face, int corner);

 private:
  struct Data;
  struct Patch;

  Patch patchAt(const Location& at);

  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf::test
