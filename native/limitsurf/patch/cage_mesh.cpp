// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/cage_mesh.h"

#include <algorithm>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A vertex or a face takes a small part of the time of an evaluation.
constexpr std::size_t kPerTask = 16384;

/// Calls visit(i) for i from 0 to count - 1, on all cores.
template <typename Visit>
void forEach(int count, const Visit& visit) {
  parallelFor(static_cast<std::size_t>(count), kPerTask, 0,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  visit(static_cast<int>(i));
                }
              });
}

template <typename Map>
void copyEntry(Map& map, int from, int to) {
  if (const auto found = map.find(from); found != map.end()) {
    map[to] = found->second;
  }
}

}  // namespace

CageMesh::CageMesh(const ControlMesh& mesh, const Topology& topology) : topology_(topology) {
  const Adjacency& adjacency = topology.adjacency();
  own_points_ = mesh.vertexCount();
  vertex_count_ = own_points_ + static_cast<int>(topology.splitFans().size());
  points_.assign(topology.splitFans().size(), -1);
  corner_vertices_ = mesh.faceVertices().data();
  corner_count_ = static_cast<int>(mesh.faceVertices().size());
  twins_ = adjacency.twins.data();
  if (!adjacency.face_of_corner.empty()) {
    for (int face = 0; face < mesh.faceCount(); ++face) {
      own_first_corners_.push_back(mesh.firstCorner(face));
    }
    own_first_corners_.push_back(corner_count_);
    first_corners_ = own_first_corners_.data();
    face_of_corner_ = adjacency.face_of_corner.data();
  }
  if (topology.hasSharpness()) {
    side_sharpness_ = topology.sideSharpness().data();
  }
  cage_fans_ = adjacency.fans.data();
  cage_sharpness_ = topology.vertexSharpness();
  averaged_edges_ = topology.seams().averaged_edges;
  lasting_corners_ = topology.seams().corners;
  fans_.resize(topology.splitFans().size());
  fan_sharpness_.resize(topology.splitFans().size());
  marks_.resize(static_cast<std::size_t>(vertex_count_));
  if (!topology.splitFans().empty()) {
    own_corner_vertices_ = mesh.faceVertices();
    splitVertices();
    corner_vertices_ = own_corner_vertices_.data();
  }
  forEach(vertex_count_, [&](int vertex) { mark(vertex); });
  if (side_sharpness_) {
    findSmoothVertices();
  }
}

void CageMesh::findSmoothVertices() {
  InterruptionStride stride;
  for (int vertex = 0; vertex < vertex_count_; ++vertex) {
    stride.step();
    smooth_.push_back(fan(vertex).closed && fan(vertex).sharpness == 0);
  }
  for (int corner = 0; corner < corner_count_; ++corner) {
    stride.step();
    if (isSharp(side_sharpness_[corner])) {
      const FaceCorner side = cornerAt(corner);
      smooth_[vertex(side)] = smooth_[vertexAfter(side, 1)] = false;
    }
  }
  for (const auto& [vertex, edges] : other_fans_edges_) {
    smooth_[vertex] = smooth_[vertex] && edges.empty();
  }
}

void CageMesh::splitVertices() {
  InterruptionStride stride;
  for (int vertex = own_points_; vertex < vertex_count_; ++vertex) {
    for (const auto& [face, corner] : topology_.splitFans()[vertex - own_points_].faces) {
      own_corner_vertices_[cornerNumber({face, corner})] = vertex;
    }
    setSplitFan(vertex);
    stride.step();
  }
}

void CageMesh::setSplitFan(int vertex) {
  const Topology::SplitFan& split = topology_.splitFans()[vertex - own_points_];
  fans_[vertex - own_points_] = {cornerNumber({split.faces[0].first, split.faces[0].second}),
                                 static_cast<int>(split.faces.size()), split.closed};
  fan_sharpness_[vertex - own_points_] = cage_sharpness_ ? cage_sharpness_[split.vertex] : 0;
  copyEntry(averaged_edges_, split.vertex, vertex);
  copyEntry(lasting_corners_, split.vertex, vertex);
  const auto& level = topology_.level();
  std::vector<int> own;
  for (const auto& [face, corner] : split.faces) {
    const auto edges = level.GetFaceEdges(face);
    own.push_back(edges[corner]);
    own.push_back(edges[(corner + edges.size() - 1) % edges.size()]);
  }
  if (split.followsCrease()) {
    crease_ends_[vertex] = split.crease_ends;
  }
  const bool last_stands_for_crease = split.followsCrease() && !split.closed;
  std::vector<float>& others = other_fans_edges_[vertex];
  for (const int edge : level.GetVertexEdges(split.vertex)) {
    if (std::find(own.begin(), own.end(), edge) == own.end() &&
        !(last_stands_for_crease && level.IsEdgeNonManifold(edge))) {
      others.push_back(level.GetEdgeSharpness(edge));
    }
  }
}

void CageMesh::mark(int vertex) {
  const bool is_split = vertex >= own_points_;
  if (!is_split && !topology_.isManifold() && topology_.level().IsVertexNonManifold(vertex)) {
    return;  // it is represented by its fans
  }
  std::uint8_t marks = kQuads;
  if (first_corners_) {
    forEachAround(fan(vertex), [&](FaceCorner at) {
      if (faceSize(at.face) != 4) {
        marks = 0;
      }
    });
  }
  if (!is_split && isRegular(vertex)) {
    marks |= kRegular;
  }
  marks_[vertex] = marks;
}

bool CageMesh::isRegular(int vertex) const {
  const VertexFan around = fan(vertex);
  const int edges = around.closed ? 4 : isInfinitelySharp(around.sharpness) ? 2 : 3;
  if (around.edges() != edges) {
    return false;
  }
  if (!side_sharpness_) {
    return true;
  }
  if (edges != 2 && isSharp(around.sharpness)) {
    return false;
  }
  bool smooth = true;
  int i = 0;
  forEachAround(around, [&](FaceCorner at) {
    // The first and the last edge of a boundary are infinitely sharp anyway.
    smooth = smooth && !((around.closed || i > 0) && isSharp(sharpness(at)));
    ++i;
  });
  return smooth;
}

bool CageMesh::regularFace(int face) const {
  if (faceSize(face) != 4) {
    return false;
  }
  for (int corner = 0; corner < 4; ++corner) {
    if (marks_[vertex({face, corner})] != (kRegular | kQuads)) {
      return false;
    }
  }
  return true;
}

std::array<bool, 4> CageMesh::diagonals(int face) const {
  std::array<bool, 4> result;
  for (int corner = 0; corner < 4; ++corner) {
    result[corner] = fan(vertex({face, corner})).closed;
  }
  return result;
}

int CageMesh::makePoint(int vertex) { return topology_.splitFans()[vertex - own_points_].vertex; }

}  // namespace limitsurf
