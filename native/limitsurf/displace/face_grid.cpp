// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/displace/face_grid.h"

#include <algorithm>

namespace limitsurf {

int FaceGrid::index(FaceOrder order, int part, int i, int j) const {
  if (order == FaceOrder::opensubdiv) {
    return recursiveIndex(part, i, j);
  }
  return parts_ == 1 ? quadIndex(i, j) : splitIndex(part, i, j);
}

int FaceGrid::recursiveIndex(int part, int i, int j) const {
  int result = part;
  for (int bit = side_log2_ - 1; bit >= 0; --bit) {
    const int right = i >> bit & 1, upper = j >> bit & 1;
    result = 4 * result + (upper ? 3 - right : right);  // counter-clockwise from (0, 0)
  }
  return result;
}

/// The order on a quad: inner faces row by row, then those along each side in turn.
int FaceGrid::quadIndex(int i, int j) const {
  const int end = side() - 1, inner = end - 1;
  if (i > 0 && i < end && j > 0 && j < end) {
    return (j - 1) * inner + i - 1;
  }
  const int first = inner * inner;
  if (j == 0 && i < end) {
    return first + i;
  }
  if (i == end && j < end) {
    return first + end + j;
  }
  if (j == end && i > 0) {
    return first + 2 * end + end - i;
  }
  return first + 3 * end + end - j;
}

/// The order on other faces: the inner faces of all parts, those beside the lines between parts,
/// those at the centre, then those along the sides.
int FaceGrid::splitIndex(int part, int i, int j) const {
  const int end = side() - 1, inner = std::max(end - 1, 0);
  if (i > 0 && j > 0 && j < end) {
    return (part * inner + j - 1) * end + i - 1;
  }
  int first = parts_ * inner * end;
  if (i > 0 && i < end && j == end) {
    const int line = (part + parts_ - 1) % parts_;
    return first + line * inner + i - 1;
  }
  first += parts_ * inner;
  if (end > 0 && i == end && j == end) {
    return first + part;
  }
  first += end > 0 ? parts_ : 0;
  return first + part * (2 * end + 1) + (j == 0 ? i : end + j);
}

}  // namespace limitsurf
