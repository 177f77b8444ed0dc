// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// The edges of a control mesh, numbered in the order in which faces use them first, and which
/// faces use them. An edge between a vertex and itself, which only faces without a surface have, is
/// none.
class MeshEdges {
 public:
  explicit MeshEdges(const ControlMesh& mesh);

  /// The use of an edge by a face: it leads from this corner of the face to the next one.
  struct Use {
    int face, corner;
  };

  int count() const { return static_cast<int>(vertices_.size()); }
  /// The edge's vertices, in the order of its first use.
  const std::array<int, 2>& vertices(int edge) const {
    return vertices_[static_cast<std::size_t>(edge)];
  }
  /// All uses of an edge, in the order of the faces.
  Span<Use> uses(int edge) const {
    const auto first = static_cast<std::size_t>(first_use_[static_cast<std::size_t>(edge)]);
    const auto last = static_cast<std::size_t>(first_use_[static_cast<std::size_t>(edge) + 1]);
    return Span<Use>(uses_).subspan(first, last - first);
  }
  /// The edge from a corner of a face, counted over the corners of all faces, to the next; -1 for
  /// an edge between a vertex and itself.
  int ofCorner(int corner) const { return of_corner_[static_cast<std::size_t>(corner)]; }
  /// The edge between two vertices, in either order, or -1.
  int find(std::int64_t a, std::int64_t b) const;

 private:
  struct Key {
    std::uint64_t vertices;  ///< the smaller one first
    int edge;
  };

  std::vector<std::array<int, 2>> vertices_;
  std::vector<int> first_use_;
  std::vector<Use> uses_;
  std::vector<int> of_corner_;
  std::vector<Key> keys_;  // sorted by vertices
};

}  // namespace limitsurf
