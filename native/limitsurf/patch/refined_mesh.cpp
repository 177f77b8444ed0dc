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
      points_(points),
      child_of_corner_(static_cast<std::size_t>(parent.cornerCount()), -1) {
  // Under Chaikin's rule the sharpness of a child edge depends on the edges at both its ends.
  markVertices(faces, has_sharpness && !crease_.IsUniform());
  makeChildren();
  makeVertices();
  makeTwins();
  if (has_sharpness_) {
    subdivideSharpness();
  }
  point_.assign(refined_vertices_.size() + new_vertices_.size(), -1);
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
  InterruptionStride stride;
  for (const int vertex : refined_vertices_) {
    stride.step();
    const VertexFan fan = parent_.fan(vertex);
    fans_.push_back({{static_cast<int>(origin_.size()), 0},
                     fan.faces,
                     fan.closed,
                     crease_.SubdivideVertexSharpness(fan.sharpness)});
    parent_.forEachAround(fan, [&](FaceCorner at) {
      child_of_corner_[parent_.cornerNumber(at)] = static_cast<int>(origin_.size());
      origin_.push_back(at);
    });
  }
}

int RefinedMesh::newVertex(Origin origin, FaceCorner at) {
  new_vertices_.push_back({origin, at});
  return static_cast<int>(refined_vertices_.size() + new_vertices_.size()) - 1;
}

void RefinedMesh::makeVertices() {
  corner_vertex_.assign(4 * origin_.size(), -1);
  const auto corner = [&](int child, int i) -> int& { return corner_vertex_[4 * child + i]; };
  // Makes the midpoint of a side, and sets it at the corners of the children beside that side.
  const auto setMidpoint = [&](FaceCorner side) {
    const int vertex = newVertex(kEdge, side);
    const auto set = [&](FaceCorner half) {
      const int begin = child(half), end = child(parent_.after(half, 1));
      if (begin >= 0) {
        corner(begin, 1) = vertex;
      }
      if (end >= 0) {
        corner(end, 3) = vertex;
      }
    };
    set(side);
    if (const FaceCorner beyond = parent_.twin(side); beyond.exists()) {
      set(beyond);
    }
  };
  InterruptionStride stride;
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    stride.step();
    const int first = fans_[v].first.face;
    for (int c = first; c < first + fans_[v].faces; ++c) {
      const FaceCorner at = origin_[c];
      corner(c, 0) = static_cast<int>(v);
      if (corner(c, 1) < 0) {
        setMidpoint(at);
      }
      if (corner(c, 3) < 0) {
        setMidpoint(parent_.before(at));
      }
      const auto [face, is_new] = face_vertex_.try_emplace(at.face, 0);
      if (is_new) {
        face->second = newVertex(kFace, {at.face, 0});
      }
      corner(c, 2) = face->second;
    }
  }
}

void RefinedMesh::makeTwins() {
  twin_.assign(corner_vertex_.size(), -1);
  const auto link = [&](int child, int side, FaceCorner other_origin, int other_side) {
    if (other_origin.exists()) {
      if (const int other = this->child(other_origin); other >= 0) {
        twin_[4 * child + side] = 4 * other + other_side;
      }
    }
  };
  InterruptionStride stride;
  for (int c = 0; c < static_cast<int>(origin_.size()); ++c) {
    stride.step();
    const FaceCorner at = origin_[c];
    const FaceCorner beyond = parent_.twin(at);
    if (beyond.exists()) {
      link(c, 0, parent_.after(beyond, 1), 3);
    }
    link(c, 1, parent_.after(at, 1), 2);
    link(c, 2, parent_.before(at), 1);
    link(c, 3, parent_.turned(at), 0);
  }
}

SharpnessAround RefinedMesh::subdivided(int parent_vertex) const {
  SharpnessAround around = parent_.sharpnessAround(parent_vertex);
  around.child_vertex = crease_.SubdivideVertexSharpness(around.vertex);
  around.child_edges = subdividedSharpness(crease_, around.edges);
  return around;
}

void RefinedMesh::subdivideSharpness() {
  side_sharpness_.assign(corner_vertex_.size(), 0);
  InterruptionStride stride;
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    stride.step();
    const VertexFan& fan = fans_[v];
    const SharpnessAround around = subdivided(refined_vertices_[v]);
    for (int i = 0; i < fan.faces; ++i) {
      float* const sides = &side_sharpness_[4 * static_cast<std::size_t>(fan.first.face + i)];
      sides[0] = around.child_edges[i];
      sides[3] = around.child_edges[fan.closed && i + 1 == fan.faces ? 0 : i + 1];
    }
    if (static_cast<int>(around.edges.size()) > fan.edges()) {
      other_fans_edges_[static_cast<int>(v)].assign(around.child_edges.begin() + fan.edges(),
                                                    around.child_edges.end());
    }
  }
}

float RefinedMesh::sharpness(FaceCorner side) const {
  if (twin_[cornerNumber(side)] < 0) {
    return kInfinitelySharp;
  }
  return has_sharpness_ ? side_sharpness_[cornerNumber(side)] : 0;
}

VertexFan RefinedMesh::fan(int vertex) const {
  const int refined = static_cast<int>(refined_vertices_.size());
  if (vertex < refined) {
    return fans_[vertex];
  }
  const NewVertex& made = new_vertices_[vertex - refined];
  if (made.origin == kFace) {
    return {{child(made.at), 2}, parent_.faceSize(made.at.face), true, 0};
  }
  const bool closed = parent_.twin(made.at).exists();
  return {{child(parent_.after(made.at, 1)), 3}, closed ? 4 : 2, closed, 0};
}

std::vector<float> RefinedMesh::edgesOfOtherFans(int vertex) const {
  const auto known = other_fans_edges_.find(vertex);
  return known == other_fans_edges_.end() ? std::vector<float>() : known->second;
}

}  // namespace limitsurf
