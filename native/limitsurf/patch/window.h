// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <tuple>
#include <utility>

#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// The vertices around a quad on the grid -1 <= x, y <= 2. A place is -1 if a boundary or an
/// infinitely sharp edge stands between it and the quad. All faces around the quad have to be
/// quads. `Mesh` is a FaceMesh.
template <typename Mesh>
class Window {
 public:
  /// Corner `origin` of the quad is put at (0, 0), the next one at (1, 0). `diagonal[i]`: whether
  /// the quad's corner i has four faces all around, so that there is a vertex diagonally beyond.
  Window(const Mesh& mesh, int face, int origin, const std::array<bool, 4>& diagonal) {
    vertices_.fill(-1);
    for (int i = 0; i < 4; ++i) {
      const FaceCorner here = {face, (origin + i) % 4};
      set(i, 0, 0, mesh.vertex(here));
      const FaceCorner beyond = mesh.across(here);
      if (!beyond.exists()) {
        continue;
      }
      set(i, 0, -1, mesh.vertex(turned(beyond, 2)));
      set(i, 1, -1, mesh.vertex(turned(beyond, 3)));
      if (diagonal[here.corner]) {
        const FaceCorner opposite = mesh.across(turned(beyond, 1));
        if (opposite.exists()) {
          set(i, -1, -1, mesh.vertex(turned(opposite, 3)));
        }
      }
    }
  }

  int at(int x, int y) const { return vertices_[(y + 1) * 4 + (x + 1)]; }

 private:
  static FaceCorner turned(FaceCorner at, int steps) { return {at.face, (at.corner + steps) % 4}; }

  /// Here (x, y) is counted from corner i, with the next corner at (1, 0).
  void set(int i, int x, int y, int vertex) {
    for (; i > 0; --i) {
      std::tie(x, y) = std::pair(1 - y, x);
    }
    vertices_[(y + 1) * 4 + (x + 1)] = vertex;
  }

  std::array<int, 16> vertices_;
};

}  // namespace limitsurf
