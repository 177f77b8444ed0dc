// SPDX-License-Identifier: Apache-2.0
//
// The points of a refined level, as combinations of the parent's.
#include <algorithm>
#include <stdexcept>

#include "limitsurf/patch/refined_mesh.h"

namespace limitsurf {

int RefinedMesh::makePoint(int vertex) {
  const int refined = static_cast<int>(refined_vertices_.size());
  if (vertex < refined) {
    return vertexPoint(vertex);
  }
  const NewVertex& made = new_vertices_[vertex - refined];
  const FaceCorner at = parent_.cornerAt(static_cast<int>(made.corner));
  return made.of_face ? facePoint(at.face) : edgePoint(at);
}

int RefinedMesh::facePoint(int face) {
  RefinedPoints::Sources sources(refined_points_);
  for (int corner = 0; corner < parent_.faceSize(face); ++corner) {
    sources.push_back(parent_.point(parent_.vertex({face, corner})));
  }
  return refined_points_.addFacePoint(sources);
}

float RefinedMesh::childSharpness(FaceCorner side) const {
  if (crease_.IsUniform()) {
    return crease_.SubdivideUniformSharpness(parent_.sharpness(side));
  }
  // Under Chaikin's rule the faces around all vertices at which new points are needed are refined
  // (markVertices), so that both ends of the edge have children, and subdivideSharpness() knows
  // them.
  return side_sharpness_own_[4 * static_cast<std::size_t>(child(side))];
}

int RefinedMesh::edgePoint(FaceCorner side) {
  const int end_0 = parent_.point(parent_.vertex(side)),
            end_1 = parent_.point(parent_.vertexAfter(side, 1));
  const FaceCorner beyond = parent_.twin(side);
  const float sharpness = parent_.sharpness(side);
  if (!beyond.exists() || sharpness >= 1) {
    return refined_points_.addMidpoint(end_0, end_1);
  }
  // A face beside the side has a child at one of its ends at least.
  const auto childBeside = [&](FaceCorner at) {
    const int begin = child(at);
    return begin >= 0 ? begin : child(parent_.after(at, 1));
  };
  const int face_0 = middle(childBeside(side)), face_1 = middle(childBeside(beyond));
  const int sizes[] = {parent_.faceSize(side.face), parent_.faceSize(beyond.face)};
  if (!isSharp(sharpness)) {
    return refined_points_.addEdgePoint({end_0, end_1, face_0, face_1}, sizes[0], sizes[1]);
  }
  const float child_sharpness[] = {childSharpness(side), childSharpness(beyond)};
  return refined_points_.addEdgePoint({end_0, end_1, face_0, face_1}, sharpness, child_sharpness,
                                      sizes[0], sizes[1]);
}

int RefinedMesh::vertexPoint(int vertex) {
  const int parent_vertex = refined_vertices_[vertex];
  const VertexFan fan = parent_.fan(parent_vertex);
  if (isInfinitelySharp(fan.sharpness)) {
    const int source = parent_.point(parent_vertex);
    return refined_points_.addVertexPoint({&source, 1}, VertexRule::corner, 0);
  }
  if (has_sharpness_ && !parent_.isSmooth(parent_vertex)) {
    getSubdivided(parent_vertex, around_);
    const int boundary_edges = fan.closed ? 0 : 1;  // at each end
    if (isSharp(around_.vertex) || std::any_of(around_.edges.begin() + boundary_edges,
                                               around_.edges.end() - boundary_edges, isSharp)) {
      return sharpVertexPoint(vertex, fan);
    }
  }
  return smoothVertexPoint(vertex, fan);
}

int RefinedMesh::farEnd(int vertex, const VertexFan& parent_fan, int edge) {
  if (edge >= parent_fan.faces) {
    if (const CreaseEnds* ends = parent_.creaseEnds(refined_vertices_[vertex])) {
      return (*ends)[parent_fan.closed ? edge - parent_fan.faces : 1];
    }
  }
  const int first = fans_[vertex].first / 4;
  return edge < parent_fan.faces
             ? parent_.point(parent_.vertexAfter(origin(first + edge), 1))
             : parent_.point(parent_.vertex(parent_.before(origin(first + parent_fan.faces - 1))));
}

int RefinedMesh::smoothVertexPoint(int vertex, const VertexFan& parent_fan) {
  RefinedPoints::Sources sources(refined_points_);
  sources.push_back(parent_.point(refined_vertices_[vertex]));
  const bool follows_crease = parent_.creaseEnds(refined_vertices_[vertex]) != nullptr;
  if (!parent_fan.closed || follows_crease) {
    const int first = parent_fan.closed ? parent_fan.faces : 0;
    sources.push_back(farEnd(vertex, parent_fan, first));
    sources.push_back(farEnd(vertex, parent_fan, parent_fan.closed ? first + 1 : parent_fan.faces));
    return refined_points_.addVertexPoint(sources, VertexRule::crease, parent_fan.edges());
  }
  for (int i = 0; i < parent_fan.faces; ++i) {
    sources.push_back(farEnd(vertex, parent_fan, i));
  }
  const int first = fans_[vertex].first / 4;
  for (int i = 0; i < parent_fan.faces; ++i) {
    sources.push_back(middle(first + i));
  }
  return refined_points_.addVertexPoint(sources, VertexRule::smooth, parent_fan.faces);
}

/// The sharpness around the vertex is `around_`.
int RefinedMesh::sharpVertexPoint(int vertex, const VertexFan& parent_fan) {
  const auto mask = refined_points_.rules().vertexMask(around_, parent_fan.faces);
  // `around_` serves other points from here on.
  RefinedPoints::Sources sources(refined_points_);
  SmallArray<double> weights(1 + mask.edges.size() + mask.faces.size());
  std::size_t count = 0;
  int crease_edges = 0;  // of the crease between other faces that the vertex follows
  const auto add = [&](int point, double weight) {
    sources.push_back(point);
    weights[count++] = weight;
  };
  add(parent_.point(refined_vertices_[vertex]), mask.vertex);
  for (std::size_t i = 0; i < mask.edges.size(); ++i) {
    if (mask.edges[i] != 0) {
      int edge = static_cast<int>(i);
      if (edge >= parent_fan.edges()) {
        if (!parent_fan.closed || !parent_.creaseEnds(refined_vertices_[vertex])) {
          throw std::logic_error("the mask of a vertex has weights on edges of another fan");
        }
        edge = parent_fan.faces + crease_edges++;
      }
      add(farEnd(vertex, parent_fan, edge), mask.edges[i]);
    }
  }
  const int first = fans_[vertex].first / 4;
  for (std::size_t i = 0; i < mask.faces.size(); ++i) {
    if (mask.faces[i] != 0) {
      add(middle(first + static_cast<int>(i)), mask.faces[i]);
    }
  }
  return refined_points_.addPoint(sources, {weights.data(), count});
}

}  // namespace limitsurf
