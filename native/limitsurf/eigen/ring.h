// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/mesh/subdivision_rules.h"

namespace limitsurf {

/// The kinds of vertices whose neighbourhood reproduces itself under subdivision.
enum class RingKind {
  interior,  ///< faces all around
  boundary,  ///< a sector of faces; the boundary is a smooth curve through the vertex
  pinned,    ///< a sector of faces; the vertex stays where it is
};

/// A vertex and its quads: vertex v, spoke points e_i (the far ends of its edges,
/// counter-clockwise) and face points f_j (opposite corners; f_j lies between e_j and e_j+1).
/// Points are numbered v, e_0, e_1, ..., f_0, f_1, ...
struct Ring {
  RingKind kind;
  int faces;

  bool interior() const { return kind == RingKind::interior; }
  int edges() const { return interior() ? faces : faces + 1; }
  int size() const { return 1 + edges() + faces; }
  int edge(int i) const { return 1 + i; }
  int face(int j) const { return 1 + edges() + j; }
  /// The spoke after e_j, counter-clockwise around the vertex.
  int nextEdge(int j) const { return edge(interior() && j + 1 == faces ? 0 : j + 1); }

  VertexRule rule() const {
    switch (kind) {
      case RingKind::interior:
        return VertexRule::smooth;
      case RingKind::boundary:
        return VertexRule::crease;
      default:
        return VertexRule::corner;
    }
  }

  friend bool operator<(const Ring& a, const Ring& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.faces < b.faces;
  }
};

/// One subdivision of a ring's points: S in the paper, as an operator that costs O(faces).
/// `Values` is a matrix with one row per point; rows may be any width.
template <typename Values>
Values subdivideRing(const Ring& ring, const Values& points) {
  using Real = typename Values::Scalar;
  const SubdivisionRules<Real> rules;
  Values next = Values::Zero(points.rows(), points.cols());

  const Real face_weight = rules.faceMask(4);
  for (int j = 0; j < ring.faces; ++j) {
    next.row(ring.face(j)) =
        face_weight * (points.row(0) + points.row(ring.edge(j)) + points.row(ring.nextEdge(j)) +
                       points.row(ring.face(j)));
  }
  const auto inner_mask = rules.edgeMask(false), boundary_mask = rules.edgeMask(true);
  for (int i = 0; i < ring.edges(); ++i) {
    const bool boundary = !ring.interior() && (i == 0 || i == ring.faces);
    const auto& mask = boundary ? boundary_mask : inner_mask;
    auto row = next.row(ring.edge(i));
    row = mask.vertices[0] * points.row(0) + mask.vertices[1] * points.row(ring.edge(i));
    if (!boundary) {
      const int before = i == 0 ? ring.faces - 1 : i - 1;
      row += mask.faces[0] * next.row(ring.face(before)) + mask.faces[1] * next.row(ring.face(i));
    }
  }
  const auto mask = rules.vertexMask(ring.rule(), ring.edges());
  next.row(0) = mask.vertex * points.row(0);
  for (std::size_t i = 0; i < mask.edges.size(); ++i) {
    next.row(0) += mask.edges[i] * points.row(ring.edge(static_cast<int>(i)));
  }
  for (std::size_t j = 0; j < mask.faces.size(); ++j) {
    next.row(0) += mask.faces[j] * next.row(ring.face(static_cast<int>(j)));
  }
  return next;
}

}  // namespace limitsurf
