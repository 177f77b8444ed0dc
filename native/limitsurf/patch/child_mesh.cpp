// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/child_mesh.h"

#include <algorithm>
#include <vector>

namespace limitsurf {

VertexId ChildMesh::ofEdge(FaceCorner side) const {
  const FaceCorner other = parent_.twin(side);
  FaceId id = corners_.number(side);
  if (other.exists()) {
    id = std::min(id, corners_.number(other));
  }
  return 3 * id + kOfEdge;
}

VertexId ChildMesh::vertex(FaceCorner at) const {
  const FaceCorner origin = corners_.at(at.face);
  switch (at.corner) {
    case 0:
      return 3 * parent_.vertex(origin) + kOfVertex;
    case 1:
      return ofEdge(origin);
    case 2:
      return 3 * origin.face + kOfFace;
    default:
      return ofEdge(parent_.before(origin));
  }
}

FaceCorner ChildMesh::twin(FaceCorner side) const {
  const FaceCorner origin = corners_.at(side.face);
  switch (side.corner) {
    case 0: {  // from the vertex to the middle of the edge, which runs the other way beyond
      const FaceCorner beyond = parent_.twin(origin);
      return beyond.exists() ? FaceCorner{corners_.number(parent_.after(beyond, 1)), 3}
                             : FaceCorner{};
    }
    case 1:
      return {corners_.number(parent_.after(origin, 1)), 2};
    case 2:
      return {corners_.number(parent_.before(origin)), 1};
    default: {
      const FaceCorner beyond = parent_.twin(parent_.before(origin));
      return beyond.exists() ? FaceCorner{corners_.number(beyond), 0} : FaceCorner{};
    }
  }
}

VertexFan ChildMesh::fan(VertexId vertex) const {
  switch (vertex % 3) {
    case kOfVertex:
      return parent_.fan(vertex / 3);
    case kOfEdge: {
      const bool interior = parent_.twin(corners_.at(vertex / 3)).exists();
      return {interior ? 4 : 2, interior, false};
    }
    default:
      return {parent_.faceSize(vertex / 3), true, false};
  }
}

FaceCorner ChildMesh::faceAt(VertexId vertex, int i) const {
  if (vertex % 3 == kOfVertex) {
    return {corners_.number(parent_.faceAt(vertex / 3, i)), 0};
  }
  if (vertex % 3 == kOfFace) {
    return {corners_.number({vertex / 3, i}), 2};
  }
  // Counter-clockwise around the edge's middle, from the child at the end of the edge: the two on
  // this side, then the two on the other, where the edge runs the opposite way.
  const FaceCorner here = corners_.at(vertex / 3);
  const FaceCorner side = i < 2 ? here : parent_.twin(here);
  return i % 2 == 0 ? FaceCorner{corners_.number(parent_.after(side, 1)), 3}
                    : FaceCorner{corners_.number(side), 1};
}

int ChildMesh::positionOf(FaceCorner at) const {
  const FaceCorner origin = corners_.at(at.face);
  switch (at.corner) {
    case 0:
      return parent_.positionOf(origin);
    case 1:
      return vertex(at) == 3 * at.face + kOfEdge ? 1 : 3;
    case 2:
      return origin.corner;
    default:
      return vertex(at) == 3 * corners_.number(parent_.before(origin)) + kOfEdge ? 0 : 2;
  }
}

int ChildMesh::point(VertexId vertex) {
  const auto known = made_.find(vertex);
  if (known != made_.end()) {
    return known->second;
  }
  const int point = makePoint(vertex);
  made_.emplace(vertex, point);
  return point;
}

int ChildMesh::makePoint(VertexId vertex) {
  const std::int64_t id = vertex / 3;
  if (vertex % 3 == kOfVertex) {
    return makeVertexPoint(id);
  }
  std::vector<int> sources;
  if (vertex % 3 == kOfFace) {
    const int size = parent_.faceSize(id);
    for (int c = 0; c < size; ++c) {
      sources.push_back(parent_.point(parent_.vertex({id, c})));
    }
    return points_.addFacePoint(sources);
  }
  const FaceCorner side = corners_.at(id), other = parent_.twin(side);
  sources = {parent_.point(parent_.vertex(side)), parent_.point(parent_.vertexAfter(side, 1))};
  if (!other.exists()) {
    return points_.addEdgePoint(sources, 0, 0);
  }
  sources.push_back(point(3 * side.face + kOfFace));
  sources.push_back(point(3 * other.face + kOfFace));
  return points_.addEdgePoint(sources, parent_.faceSize(side.face), parent_.faceSize(other.face));
}

int ChildMesh::makeVertexPoint(VertexId vertex) {
  const VertexFan fan = parent_.fan(vertex);
  std::vector<int> sources = {parent_.point(vertex)};
  if (fan.pinned) {
    return points_.addVertexPoint(sources, VertexRule::corner, 0);
  }
  for (int i = 0; i < fan.faces; ++i) {
    sources.push_back(parent_.point(parent_.vertexAfter(parent_.faceAt(vertex, i), 1)));
  }
  if (!fan.interior) {
    const FaceCorner last = parent_.faceAt(vertex, fan.faces - 1);
    sources.push_back(parent_.point(parent_.vertex(parent_.before(last))));
    return points_.addVertexPoint(sources, VertexRule::crease, fan.faces + 1);
  }
  for (int i = 0; i < fan.faces; ++i) {
    sources.push_back(point(3 * parent_.faceAt(vertex, i).face + kOfFace));
  }
  return points_.addVertexPoint(sources, VertexRule::smooth, fan.faces);
}

}  // namespace limitsurf
