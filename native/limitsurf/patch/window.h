// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// The vertices around a quad on the grid -1 <= x, y <= 2. A place is -1 if a boundary or an
/// infinitely sharp edge stands between it and the quad. All faces around the quad have to be
/// quads.
class Window {
 public:
  /// Corner `origin` of the quad is put at (0, 0), the next one at (1, 0). `diagonal[i]`: whether
  /// the quad's corner i has four faces all around, so that there is a vertex diagonally beyond.
  Window(const FaceMesh& mesh, int face, int origin, const std::array<bool, 4>& diagonal) {
    vertices_.fill(-1);
    for (int i = 0; i < 4; ++i) {
      const Places& places = kPlaces[i];
      const FaceCorner here = {face, (origin + i) % 4};
      vertices_[places.corner] = mesh.vertex(here);
      const FaceCorner beyond = mesh.across(here);
      if (!beyond.exists()) {
        continue;
      }
      vertices_[places.below_begin] = mesh.vertex(turned(beyond, 2));
      vertices_[places.below_end] = mesh.vertex(turned(beyond, 3));
      if (diagonal[here.corner]) {
        const FaceCorner opposite = mesh.across(turned(beyond, 1));
        if (opposite.exists()) {
          vertices_[places.diagonal] = mesh.vertex(turned(opposite, 3));
        }
      }
    }
  }

  int at(int x, int y) const { return vertices_[(y + 1) * 4 + (x + 1)]; }

 private:
  static FaceCorner turned(FaceCorner at, int steps) { return {at.face, (at.corner + steps) % 4}; }

  /// Where a corner of the quad stands, and what is at (0, -1), (1, -1) and (-1, -1) if the corner
  /// is at (0, 0) and the next one at (1, 0).
  struct Places {
    int corner, below_begin, below_end, diagonal;
  };
  static constexpr Places kPlaces[4] = {
      {5, 1, 2, 0}, {6, 7, 11, 3}, {10, 14, 13, 15}, {9, 8, 4, 12}};

  std::array<int, 16> vertices_;
};

}  // namespace limitsurf
