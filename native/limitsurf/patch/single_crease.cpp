// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/single_crease.h"

namespace limitsurf {
namespace {

/// Replaces weights on the points r after a blended step by weights on the points q before it:
///   r-1 = (q-1 + q0) / 2, r0 = q0 + g (q-1 - 2 q0 + q1), r1 = (q0 + q1) / 2,
///   r2 = (q0 + 6 q1 + q2) / 8, r3 = (q1 + q2) / 2
/// with g = (1 - remainder) / 8. The window begins at r-1, or at r0 if `far`.
void undoBlendedStep(CubicWeights& w, double g, bool far) {
  const int skip = far ? 1 : 0;
  double value[5] = {}, first[4] = {}, second[3] = {};
  for (int i = 0; i < 4; ++i) {
    value[i + skip] = w.value[i];
  }
  for (int i = 0; i < 3; ++i) {
    first[i + skip] = 2 * w.first[i];
  }
  for (int i = 0; i < 2; ++i) {
    second[i + skip] = 4 * w.second[i];
  }
  w.value[0] = value[0] / 2 + g * value[1];
  w.value[1] = value[0] / 2 + (1 - 2 * g) * value[1] + value[2] / 2 + value[3] / 8;
  w.value[2] = g * value[1] + value[2] / 2 + value[3] * 3 / 4 + value[4] / 2;
  w.value[3] = value[3] / 8 + value[4] / 2;
  w.first[0] = first[0] / 2 + g * (first[1] - first[0]);
  w.first[1] = first[1] / 2 - g * (first[1] - first[0]) + (3 * first[2] + first[3]) / 8;
  w.first[2] = (first[2] + 3 * first[3]) / 8;
  w.second[0] = (0.5 - 2 * g) * second[0] + g * second[1];
  w.second[1] = second[1] / 8 + second[2] / 4;
}

/// The same for n = -log2(size) steps in which the point on the crease stays where it is:
///   q-1 - p0 = size (p-1 - p0), q0 = p0, q1 - p0 = size (p1 - p0),
///   q0 - 2 q1 + q2 = size^3 (p0 - 2 p1 + p2).
void undoPinnedSteps(CubicWeights& w, double size) {
  const double cube = size * size * size, square = size * size;
  const double v3 = w.value[3], f2 = w.first[2];
  w.value[1] += (1 - size) * w.value[0] + (1 - size) * w.value[2] + (1 - 2 * size + cube) * v3;
  w.value[0] *= size;
  w.value[2] = size * w.value[2] + 2 * (size - cube) * v3;
  w.value[3] = cube * v3;
  w.first[1] += (1 - square) * f2;
  w.first[2] = square * f2;
  w.second[0] /= size;
  w.second[1] *= size;
}

/// Makes the last point the linear continuation of its neighbours.
void foldLast(CubicWeights& w) {
  w.value[2] += 2 * w.value[3];
  w.value[1] -= w.value[3];
  w.value[3] = 0;
  w.first[1] += w.first[2];
  w.first[2] = 0;
  w.second[1] = 0;
}

}  // namespace

SingleCrease::SingleCrease(float sharpness) {
  while (sharpness >= 1) {
    sharpness -= 1;
    size_ /= 2;
  }
  remainder_ = sharpness;
}

CubicWeights SingleCrease::weights(double t, bool cut) const {
  if (size_ < 1 && t >= size_) {
    return CubicWeights(t, true, cut);
  }
  const double inner = t / size_;
  const bool blended = remainder_ > 0, far = blended && inner >= 0.5;
  CubicWeights w(blended ? (far ? 2 * inner - 1 : 2 * inner) : inner, false, false);
  if (blended) {
    undoBlendedStep(w, (1 - remainder_) / 8, far);
  }
  undoPinnedSteps(w, size_);
  if (cut) {
    foldLast(w);
  }
  return w;
}

int SingleCrease::strips(double borders[kMostStrips + 1]) const {
  int count = 0;
  borders[0] = 0;
  if (remainder_ > 0) {
    borders[++count] = size_ / 2;
  }
  borders[++count] = size_;
  if (size_ < 1) {
    borders[++count] = 1;
  }
  return count;
}

}  // namespace limitsurf
