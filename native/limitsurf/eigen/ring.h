// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/eigen/tile_grid.h"
#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {

/// The kinds of vertices whose neighbourhood has the same form after every subdivision.
enum class RingKind {
  interior,  ///< faces all around
  boundary,  ///< a sector of faces; the boundary is a smooth curve through the vertex
  pinned,    ///< a sector of faces; the vertex stays where it is
  cone,      ///< faces all around; the vertex stays where it is
  dart,      ///< faces all around; the sharp edge e_0 ends at the vertex, which follows the smooth
             ///< rule
  tip,       ///< faces all around; the vertex lies on a crease between other faces and follows it
  loop,  ///< a sector between the two sides of one edge of a crease, which goes on at the vertex
         ///< without bounding the sector
};

/// A vertex and its quads: vertex v, spoke points e_i (the far ends of its edges,
/// counter-clockwise) and face points f_j (opposite corners; f_j lies between e_j and e_j+1).
/// Points are numbered v, e_0, e_1, ..., f_0, f_1, ...
///
/// The rings on a crease that is not their own boundary have a point of it that is none of their
/// spokes: a tip has the mean of the two far ends as its last point; a loop of k faces, whose first
/// and last spoke are the same edge, has the other far end for e_k.
struct Ring {
  RingKind kind;
  int faces;

  /// Whether faces stand all around the vertex, so that the last one meets the first.
  bool closed() const {
    return kind != RingKind::boundary && kind != RingKind::pinned && kind != RingKind::loop;
  }
  int edges() const { return closed() ? faces : faces + 1; }
  int size() const { return 1 + edges() + faces + (kind == RingKind::tip ? 1 : 0); }
  int edge(int i) const { return 1 + i; }
  int face(int j) const { return 1 + edges() + j; }
  /// The mean of the crease's far ends. Only a tip has it.
  int creaseMean() const { return 1 + 2 * faces; }
  /// The spoke after e_j, counter-clockwise around the vertex.
  int nextEdge(int j) const {
    const bool first_again = closed() || kind == RingKind::loop;
    return edge(first_again && j + 1 == faces ? 0 : j + 1);
  }
  /// Whether spoke e_i is a boundary or infinitely sharp: no face beyond it moves its points.
  bool sharp(int i) const {
    return closed() ? kind == RingKind::dart && i == 0 : i == 0 || i == faces;
  }
  Sides sides(int face) const {
    const bool left = sharp(face), right = sharp(closed() ? (face + 1) % faces : face + 1);
    return left && right ? Sides::both : left ? Sides::left : right ? Sides::right : Sides::inner;
  }

  VertexRule rule() const {
    switch (kind) {
      case RingKind::interior:
      case RingKind::dart:
        return VertexRule::smooth;
      case RingKind::boundary:
      case RingKind::tip:
      case RingKind::loop:
        return VertexRule::crease;
      default:
        return VertexRule::corner;
    }
  }

  friend bool operator<(const Ring& a, const Ring& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.faces < b.faces;
  }
};

/// One subdivision of a ring's points: the matrix S of Lacewell & Burley 2007 (section 5), applied
/// in O(faces). It holds the masks of one kind of ring.
template <typename Real>
class RingStep {
 public:
  explicit RingStep(const Ring& ring)
      : ring_(ring),
        face_(SubdivisionRules<Real>().faceMask(4)),
        edge_(SubdivisionRules<Real>().edgeMask(false)),
        sharp_edge_(SubdivisionRules<Real>().edgeMask(true)),
        vertex_(SubdivisionRules<Real>().vertexMask(
            ring.rule(), ring.kind == RingKind::tip ? kCreaseEdges : ring.edges())) {}

  /// `at(i)` returns point i; `next(i)` returns a reference to the new point i. Points are numbers
  /// or vectors.
  template <typename At, typename Next>
  void apply(const At& at, const Next& next) const {
    for (int j = 0; j < ring_.faces; ++j) {
      next(ring_.face(j)) =
          face_ * (at(0) + at(ring_.edge(j)) + at(ring_.nextEdge(j)) + at(ring_.face(j)));
    }
    for (int i = 0; i < ring_.edges(); ++i) {
      const int e = ring_.edge(i);
      if (ring_.sharp(i)) {
        next(e) = sharp_edge_.vertices[0] * at(0) + sharp_edge_.vertices[1] * at(e);
      } else {
        const int before = i == 0 ? ring_.faces - 1 : i - 1;
        next(e) = edge_.vertices[0] * at(0) + edge_.vertices[1] * at(e) +
                  edge_.faces[0] * next(ring_.face(before)) + edge_.faces[1] * next(ring_.face(i));
      }
    }
    next(0) = vertex_.vertex * at(0);
    if (ring_.kind == RingKind::tip) {
      const int mean = ring_.creaseMean();
      next(0) += (vertex_.edges[0] + vertex_.edges[kCreaseEdges - 1]) * at(mean);
      next(mean) = sharp_edge_.vertices[0] * at(0) + sharp_edge_.vertices[1] * at(mean);
      return;
    }
    for (std::size_t i = 0; i < vertex_.edges.size(); ++i) {
      if (vertex_.edges[i] != 0) {  // 0 at the inner spokes of a boundary
        next(0) += vertex_.edges[i] * at(ring_.edge(static_cast<int>(i)));
      }
    }
    for (std::size_t j = 0; j < vertex_.faces.size(); ++j) {
      next(0) += vertex_.faces[j] * next(ring_.face(static_cast<int>(j)));
    }
  }

 private:
  static constexpr int kCreaseEdges = 2;

  Ring ring_;
  Real face_;
  typename SubdivisionRules<Real>::EdgeMask edge_, sharp_edge_;
  typename SubdivisionRules<Real>::VertexMask vertex_;
};

/// The same for a matrix with one row per point.
template <typename Values>
Values subdivideRing(const Ring& ring, const Values& points) {
  Values next(points.rows(), points.cols());
  RingStep<typename Values::Scalar>(ring).apply([&](int i) { return points.row(i); },
                                                [&](int i) { return next.row(i); });
  return next;
}

}  // namespace limitsurf
