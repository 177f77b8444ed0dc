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
    const int first = mesh.cornerNumber({face, origin});
    if (mesh.onlyQuads()) {
      fill<true>(mesh, first, first - origin, diagonal);
    } else {
      fill<false>(mesh, first, first - origin, diagonal);
    }
  }

  int at(int x, int y) const { return vertices_[(y + 1) * 4 + (x + 1)]; }

 private:
  /// `first`: the number of the corner at (0, 0), `quad`: that of the quad's corner 0.
  template <bool kOnlyQuads>
  void fill(const FaceMesh& mesh, int first, int quad, const std::array<bool, 4>& diagonal) {
    for (int i = 0; i < 4; ++i) {
      const Places& places = kPlaces[i];
      const int here = mesh.aroundQuad<kOnlyQuads>(first, i);
      vertices_[places.corner] = mesh.vertexAt(here);
      const int beyond = mesh.acrossAt(here);
      if (beyond < 0) {
        continue;
      }
      vertices_[places.below_begin] = mesh.vertexAt(mesh.aroundQuad<kOnlyQuads>(beyond, 2));
      vertices_[places.below_end] = mesh.vertexAt(mesh.aroundQuad<kOnlyQuads>(beyond, 3));
      if (diagonal[here - quad]) {
        const int opposite = mesh.acrossAt(mesh.aroundQuad<kOnlyQuads>(beyond, 1));
        if (opposite >= 0) {
          vertices_[places.diagonal] = mesh.vertexAt(mesh.aroundQuad<kOnlyQuads>(opposite, 3));
        }
      }
    }
  }

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
