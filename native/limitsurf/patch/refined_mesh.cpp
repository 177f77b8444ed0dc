// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refined_mesh.h"

#include <algorithm>
#include <stdexcept>

namespace limitsurf {

RefinedMesh::RefinedMesh(FaceMesh& parent, const std::vector<int>& faces,
                         const SubdivisionOptions& options, bool has_sharpness,
                         RefinedPoints& points)
    : parent_(parent),
      has_sharpness_(has_sharpness),
      crease_(sdcOptions(options)),
      points_(points),
      child_of_corner_(static_cast<std::size_t>(parent.cornerCount()), -1) {
  // What Chaikin's rule makes of an edge hangs on the edges at both its ends.
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
  std::for_each(faces.begin(), faces.end(), mark);
  if (with_neighbours) {
    const std::vector<int> inner = refined_vertices_;
    for (const int vertex : inner) {
      parent_.forEachAround(parent_.fan(vertex), [&](FaceCorner at) { mark(at.face); });
    }
  }
}

void RefinedMesh::makeChildren() {
  for (const int vertex : refined_vertices_) {
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
  // The midpoint of a side, and in which corners of the children beside it it stands.
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
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
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
  for (int c = 0; c < static_cast<int>(origin_.size()); ++c) {
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
  around.child_edges.resize(around.edges.size());
  crease_.SubdivideEdgeSharpnessesAroundVertex(static_cast<int>(around.edges.size()),
                                               around.edges.data(), around.child_edges.data());
  return around;
}

void RefinedMesh::subdivideSharpness() {
  side_sharpness_.assign(corner_vertex_.size(), 0);
  for (std::size_t v = 0; v < refined_vertices_.size(); ++v) {
    const VertexFan& fan = fans_[v];
    const SharpnessAround around = subdivided(refined_vertices_[v]);
    for (int i = 0; i < fan.faces; ++i) {
      float* const sides = &side_sharpness_[4 * static_cast<std::size_t>(fan.first.face + i)];
      sides[0] = around.child_edges[i];
      sides[3] = around.child_edges[fan.closed && i + 1 == fan.faces ? 0 : i + 1];
    }
    if (static_cast<int>(around.edges.size()) > fan.edges()) {
      strange_edges_[static_cast<int>(v)].assign(around.child_edges.begin() + fan.edges(),
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

std::vector<float> RefinedMesh::strangeEdges(int vertex) const {
  const auto known = strange_edges_.find(vertex);
  return known == strange_edges_.end() ? std::vector<float>() : known->second;
}

int RefinedMesh::point(int vertex) {
  if (point_[vertex] < 0) {
    const int refined = static_cast<int>(refined_vertices_.size());
    if (vertex < refined) {
      point_[vertex] = vertexPoint(refined_vertices_[vertex]);
    } else {
      const NewVertex& made = new_vertices_[vertex - refined];
      point_[vertex] = made.origin == kFace ? facePoint(made.at.face) : edgePoint(made.at);
    }
  }
  return point_[vertex];
}

int RefinedMesh::facePoint(int face) {
  std::vector<int> sources;
  for (int corner = 0; corner < parent_.faceSize(face); ++corner) {
    sources.push_back(parent_.point(parent_.vertex({face, corner})));
  }
  return points_.addFacePoint(sources);
}

float RefinedMesh::childSharpness(FaceCorner side) const {
  if (crease_.IsUniform()) {
    return crease_.SubdivideUniformSharpness(parent_.sharpness(side));
  }
  const int vertex = parent_.vertex(side);
  int index = 0, i = 0;
  parent_.forEachAround(parent_.fan(vertex), [&](FaceCorner at) {
    if (at == side) {
      index = i;
    }
    ++i;
  });
  return subdivided(vertex).child_edges[index];
}

int RefinedMesh::edgePoint(FaceCorner side) {
  std::vector<int> sources = {parent_.point(parent_.vertex(side)),
                              parent_.point(parent_.vertexAfter(side, 1))};
  const FaceCorner beyond = parent_.twin(side);
  const float sharpness = parent_.sharpness(side);
  if (!beyond.exists() || sharpness >= 1) {
    return points_.addMidpoint(sources[0], sources[1]);
  }
  sources.push_back(point(face_vertex_.at(side.face)));
  sources.push_back(point(face_vertex_.at(beyond.face)));
  const int sizes[] = {parent_.faceSize(side.face), parent_.faceSize(beyond.face)};
  if (!isSharp(sharpness)) {
    return points_.addEdgePoint(sources, sizes[0], sizes[1]);
  }
  const float child_sharpness[] = {childSharpness(side), childSharpness(beyond)};
  return points_.addEdgePoint(sources, sharpness, child_sharpness, sizes[0], sizes[1]);
}

int RefinedMesh::vertexPoint(int vertex) {
  const VertexFan fan = parent_.fan(vertex);
  std::vector<int> sources = {parent_.point(vertex)};
  if (isInfinitelySharp(fan.sharpness)) {
    return points_.addVertexPoint(sources, VertexRule::corner, 0);
  }
  const SharpnessAround around = has_sharpness_ ? subdivided(vertex) : SharpnessAround{};
  const bool sharp_inside =
      isSharp(around.vertex) ||
      std::any_of(around.edges.begin() + (fan.closed || around.edges.empty() ? 0 : 1),
                  around.edges.end() - (fan.closed || around.edges.empty() ? 0 : 1), isSharp);
  std::vector<FaceCorner> corners;
  parent_.forEachAround(fan, [&](FaceCorner at) { corners.push_back(at); });
  const auto farEnd = [&](int edge) {
    return edge < fan.faces ? parent_.point(parent_.vertexAfter(corners[edge], 1))
                            : parent_.point(parent_.vertex(parent_.before(corners.back())));
  };
  if (!sharp_inside) {
    if (!fan.closed) {
      sources.push_back(farEnd(0));
      sources.push_back(farEnd(fan.faces));
      return points_.addVertexPoint(sources, VertexRule::crease, fan.edges());
    }
    for (int i = 0; i < fan.faces; ++i) {
      sources.push_back(farEnd(i));
    }
    for (const FaceCorner at : corners) {
      sources.push_back(point(face_vertex_.at(at.face)));
    }
    return points_.addVertexPoint(sources, VertexRule::smooth, fan.faces);
  }

  const auto mask = points_.rules().vertexMask(around, fan.faces);
  std::vector<double> weights = {mask.vertex};
  for (std::size_t i = 0; i < mask.edges.size(); ++i) {
    if (mask.edges[i] != 0) {
      if (static_cast<int>(i) >= fan.edges()) {
        throw std::logic_error("a vertex moves along edges that are not its own");
      }
      sources.push_back(farEnd(static_cast<int>(i)));
      weights.push_back(mask.edges[i]);
    }
  }
  for (std::size_t i = 0; i < mask.faces.size(); ++i) {
    if (mask.faces[i] != 0) {
      sources.push_back(point(face_vertex_.at(corners[i].face)));
      weights.push_back(mask.faces[i]);
    }
  }
  return points_.addPoint(sources, weights);
}

}  // namespace limitsurf
