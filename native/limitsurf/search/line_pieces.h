// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/interruption_point.h"
#include "limitsurf/search/polylines.h"

namespace limitsurf {

/// Calls body(from, to) for the ends of each straight line of positive length. Can be interrupted.
template <typename Body>
void forEachLine(const Polylines& curves, const Body& body) {
  InterruptionStride stride;
  for (std::size_t curve = 0; curve + 1 < curves.offsets.size(); ++curve) {
    stride.step();
    for (std::int64_t row = curves.offsets[curve] + 1; row < curves.offsets[curve + 1]; ++row) {
      stride.step();
      const Vector3 from = curves.points.row(row - 1), to = curves.points.row(row);
      if (from != to) {
        body(from, to);
      }
    }
  }
}

/// Curves are divided into at most so many pieces.
constexpr std::int64_t kMostPieces = 30'000'000;

/// The least number of equal pieces of a line, none longer than `spacing`: 1 to kMostPieces + 1.
std::int64_t piecesOfLine(const Vector3& from, const Vector3& to, double spacing);

/// The number of such pieces of all lines of positive length. Throws std::invalid_argument for more
/// than kMostPieces, with the name of the points and the line at which there are too many.
std::int64_t countPieces(const Polylines& curves, double spacing, const char* points_name);

}  // namespace limitsurf
