// SPDX-License-Identifier: Apache-2.0
//
// The points of a refined level, as combinations of the parent's.
#include <algorithm>
#include <stdexcept>

#include "limitsurf/patch/refined_mesh.h"

namespace limitsurf {

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
  sources.reserve(static_cast<std::size_t>(parent_.faceSize(face)));
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
  if (isInfinitelySharp(fan.sharpness)) {
    return points_.addVertexPoint({parent_.point(vertex)}, VertexRule::corner, 0);
  }
  const VertexNeighbours around = neighbours(vertex, fan);
  const SharpnessAround sharpness = has_sharpness_ ? subdivided(vertex) : SharpnessAround{};
  const int boundary_edges = fan.closed || sharpness.edges.empty() ? 0 : 1;  // at each end
  const bool sharp_inside =
      isSharp(sharpness.vertex) || std::any_of(sharpness.edges.begin() + boundary_edges,
                                               sharpness.edges.end() - boundary_edges, isSharp);
  return sharp_inside ? sharpVertexPoint(around, sharpness) : smoothVertexPoint(around);
}

RefinedMesh::VertexNeighbours RefinedMesh::neighbours(int vertex, const VertexFan& fan) const {
  VertexNeighbours result{vertex, fan, {}};
  parent_.forEachAround(fan, [&](FaceCorner at) { result.corners.push_back(at); });
  return result;
}

int RefinedMesh::farEnd(const VertexNeighbours& around, int edge) {
  return edge < around.fan.faces
             ? parent_.point(parent_.vertexAfter(around.corners[edge], 1))
             : parent_.point(parent_.vertex(parent_.before(around.corners.back())));
}

int RefinedMesh::smoothVertexPoint(const VertexNeighbours& around) {
  const VertexFan& fan = around.fan;
  std::vector<int> sources = {parent_.point(around.vertex)};
  if (!fan.closed) {
    sources.push_back(farEnd(around, 0));
    sources.push_back(farEnd(around, fan.faces));
    return points_.addVertexPoint(sources, VertexRule::crease, fan.edges());
  }
  for (int i = 0; i < fan.faces; ++i) {
    sources.push_back(farEnd(around, i));
  }
  for (const FaceCorner at : around.corners) {
    sources.push_back(point(face_vertex_.at(at.face)));
  }
  return points_.addVertexPoint(sources, VertexRule::smooth, fan.faces);
}

int RefinedMesh::sharpVertexPoint(const VertexNeighbours& around,
                                  const SharpnessAround& sharpness) {
  const auto mask = points_.rules().vertexMask(sharpness, around.fan.faces);
  std::vector<int> sources = {parent_.point(around.vertex)};
  std::vector<double> weights = {mask.vertex};
  for (std::size_t i = 0; i < mask.edges.size(); ++i) {
    if (mask.edges[i] != 0) {
      if (static_cast<int>(i) >= around.fan.edges()) {
        throw std::logic_error("the mask of a vertex has weights on edges of another fan");
      }
      sources.push_back(farEnd(around, static_cast<int>(i)));
      weights.push_back(mask.edges[i]);
    }
  }
  for (std::size_t i = 0; i < mask.faces.size(); ++i) {
    if (mask.faces[i] != 0) {
      sources.push_back(point(face_vertex_.at(around.corners[i].face)));
      weights.push_back(mask.faces[i]);
    }
  }
  return points_.addPoint(sources, weights);
}

}  // namespace limitsurf
