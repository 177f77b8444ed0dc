// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refined_mesh.h"

#include <algorithm>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

RefinedMesh::RefinedMesh(FaceMesh& parent, const std::vector<int>& faces,
                         const SubdivisionOptions& options, bool has_sharpness,
                         RefinedPoints& points)
    : parent_(parent),
      has_sharpness_(has_sharpness),
      crease_(sdcOptions(options)),
      refined_points_(points),
      child_of_corner_(static_cast<std::size_t>(parent.cornerCount()), -1) {
  // Under Chaikin's rule the sharpness of a child edge depends on the edges at both its ends.
  markVertices(faces, has_sharpness && !crease_.IsUniform());
  makeChildren();
  makeVertices();
  makeTwins();
  if (has_sharpness_) {
    subdivideSharpness();
  }
  followCreases();
  vertex_count_ = static_cast<int>(fans_.size());
  points_.assign(fans_.size(), -1);
}

void RefinedMesh::markVertices(const std::vector<int>& faces, bool with_neighbours) {
  std::vector<bool> marked(static_cast<std::size_t>(parent_.vertexCount()), false);
  const auto mark = [&](int face) {
    for (int corner = 0; corner < parent_.faceSize(face); ++corner) {
      const int vertex = parent_.vertex({face, corner});
      if (!marked[vertex]) {
        marked[vertex] = true;
        refined_vertices_.push_back(vertex);
      }
    }
  };
  InterruptionStride stride;
  for (const int face : faces) {
    mark(face);
    stride.step();
  }
  if (with_neighbours) {
    const std::vector<int> inner = refined_vertices_;
    for (const int vertex : inner) {
      stride.step();
      parent_.forEachAround(parent_.fan(vertex), [&](FaceCorner at) { mark(at.face); });
    }
  }
}

void RefinedMesh::makeChildren() {
  // Where all faces of a mesh of quads are refined, each vertex has four corners for its own.
  origin_.reserve(4 * refined_vertices_.size());
  InterruptionStride stride;
  for (const int vertex : refined_vertices_) {
    stride.step();
    const VertexFan fan = parent_.fan(vertex);
    fans_.push_back({4 * static_cast<int>(origin_.size()), fan.faces, fan.closed});
    fan_sharpness_.push_back(childVertexSharpness(vertex, fan.sharpness));
    parent_.forEachAround(fan, [&](FaceCorner at) {
      const int corner = parent_.cornerNumber(at);
      child_of_corner_[corner] = static_cast<int>(origin_.size());
      origin_.push_back(corner);
    });
  }
}

int RefinedMesh::newVertex(NewVertex origin, StoredFan fan) {
  new_vertices_.push_back(origin);
  fans_.push_back(fan);
  return static_cast<int>(fans_.size()) - 1;
}

/// Makes the midpoint of a side, and sets it at the corners of the children beside that side.
void RefinedMesh::setMidpoint(FaceCorner side) {
  const FaceCorner beyond = parent_.twin(side);
  const bool closed = beyond.exists();
  const int first = 4 * child(parent_.after(side, 1)) + 3;
  const int vertex = newVertex({static_cast<unsigned>(parent_.cornerNumber(side)), false},
                               {first, closed ? 4 : 2, closed});
  const auto set = [&](FaceCorner half) {
    const int begin = child(half), end = child(parent_.after(half, 1));
    if (begin >= 0) {
      corner_vertices_own_[4 * begin + 1] = vertex;
    }
    if (end >= 0) {
      corner_vertices_own_[4 * end + 3] = vertex;
    }
  };
  set(side);
  if (closed) {
    set(beyond);
  }
}

/// Makes the vertex in the middle of a face, and sets it at its children.
void RefinedMesh::setMiddle(int face) {
  const int size = parent_.faceSize(face);
  const int vertex = newVertex({static_cast<unsigned>(parent_.cornerNumber({face, 0})), true},
                               {4 * child({face, 0}) + 2, size, true});
  for (int corner = 0; corner < size; ++corner) {
    if (const int at = child({face, corner}); at >= 0) {
      corner_vertices_own_[4 * at + 2] = vertex;
    }
  }
}

void RefinedMesh::makeVertices() {
  // Each child has a side and a face at its vertex; the system hands out memory when it is used.
  new_vertices_.reserve(refined_vertices_.size() + 2 * origin_.size());
  fans_.reserve(2 * refined_vertices_.size() + 2 * origin_.size());
  corner_vertices_own_.assign(4 * origin_.size(), -1);
  corner_vertices_ = corner_vertices_own_.data();
  corner_count_ = static_cast<int>(corner_vertices_own_.size());
  InterruptionStride stride;
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    stride.step();
    const int first = fans_[v].first / 4;
    for (int c = first; c < first + fans_[v].faces; ++c) {
      int* const corners = &corner_vertices_own_[4 * c];
      corners[0] = static_cast<int>(v);
      if (corners[1] < 0) {
        setMidpoint(origin(c));
      }
      if (corners[3] < 0) {
        setMidpoint(parent_.before(origin(c)));
      }
      if (corners[2] < 0) {
        setMiddle(origin(c).face);
      }
    }
  }
}

void RefinedMesh::makeTwins() {
  twins_own_.assign(corner_vertices_own_.size(), -1);
  twins_ = twins_own_.data();
  const auto link = [&](int child, int side, FaceCorner other_origin, int other_side) {
    if (other_origin.exists()) {
      if (const int other = this->child(other_origin); other >= 0) {
        twins_own_[4 * child + side] = 4 * other + other_side;
      }
    }
  };
  InterruptionStride stride;
  for (int c = 0; c < static_cast<int>(origin_.size()); ++c) {
    stride.step();
    const FaceCorner at = origin(c);
    const FaceCorner beyond = parent_.twin(at);
    if (beyond.exists()) {
      link(c, 0, parent_.after(beyond, 1), 3);
    }
    const FaceCorner before = parent_.before(at);
    link(c, 1, parent_.after(at, 1), 2);
    link(c, 2, before, 1);
    link(c, 3, parent_.twin(before), 0);
  }
}

/// A crease between faces of other fans has no edges here: the new points of those that a vertex
/// follows are made for the vertex.
void RefinedMesh::followCreases() {
  if (!parent_.hasCreaseEnds()) {
    return;
  }
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    if (const CreaseEnds* ends = parent_.creaseEnds(refined_vertices_[v])) {
      const int vertex = parent_.point(refined_vertices_[v]);
      crease_ends_[static_cast<int>(v)] = {refined_points_.addMidpoint(vertex, (*ends)[0]),
                                           refined_points_.addMidpoint(vertex, (*ends)[1])};
    }
  }
}

void RefinedMesh::getSubdivided(int parent_vertex, SharpnessAround& around) const {
  parent_.getSharpnessAround(parent_vertex, around);
  around.child_vertex = childVertexSharpness(parent_vertex, around.vertex);
  around.subdivideEdges(crease_);
}

float RefinedMesh::childVertexSharpness(int parent_vertex, float sharpness) const {
  const LastingCorner* corner = parent_.lastingCorner(parent_vertex);
  return corner          ? corner->lasts() ? corner->next().sharpness() : 0
         : sharpness > 0 ? crease_.SubdivideVertexSharpness(sharpness)
                         : 0;
}

void RefinedMesh::subdivideSharpness() {
  side_sharpness_own_.assign(corner_vertices_own_.size(), 0);
  side_sharpness_ = side_sharpness_own_.data();
  // Of new vertices, only those in the middle of a sharp edge are not smooth.
  for (const StoredFan& fan : fans_) {
    smooth_.push_back(fan.closed);
  }
  InterruptionStride stride;
  SharpnessAround around;
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    stride.step();
    if (parent_.isSmooth(refined_vertices_[v])) {
      continue;
    }
    const VertexFan fan = this->fan(static_cast<int>(v));
    getSubdivided(refined_vertices_[v], around);
    smooth_[v] = fan.closed && fan.sharpness == 0 &&
                 std::none_of(around.child_edges.begin(), around.child_edges.end(), isSharp);
    for (int i = 0; i < fan.faces; ++i) {
      const int child = fan.first.face + i;
      float* const sides = &side_sharpness_own_[4 * static_cast<std::size_t>(child)];
      sides[0] = around.child_edges[i];
      sides[3] = around.child_edges[fan.closed && i + 1 == fan.faces ? 0 : i + 1];
      if (isSharp(sides[0])) {
        smooth_[corner_vertices_own_[4 * child + 1]] = false;
      }
    }
    if (static_cast<int>(around.edges.size()) > fan.edges()) {
      other_fans_edges_[static_cast<int>(v)].assign(around.child_edges.begin() + fan.edges(),
                                                    around.child_edges.end());
    }
    if (!around.averaged_child_edges.empty()) {
      averaged_edges_[static_cast<int>(v)] = around.averaged_child_edges;
    }
    const LastingCorner* corner = parent_.lastingCorner(refined_vertices_[v]);
    if (corner && corner->lasts()) {
      lasting_corners_[static_cast<int>(v)] = corner->next();
    }
  }
}

}  // namespace limitsurf
