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

/// The sharp edges at a vertex in which several fans meet that do not belong to one of its fans.
/// All edges are looked at once for a vertex, not for each fan: thousands of faces may share one
/// edge.
class EdgesOfOtherFans {
 public:
  explicit EdgesOfOtherFans(const OpenSubdiv::Far::TopologyLevel& level) : level_(level) {}

  /// Their sharpness, in any order. Of the infinitely sharp ones there are at most as many as make
  /// a vertex a corner: more of them change neither its rule nor the sharpness of its other edges.
  std::vector<float> of(const Topology::SplitFan& fan) {
    if (fan.vertex != vertex_) {
      findSharpEdges(fan.vertex);
    }
    findOwnEdges(fan);
    std::vector<float> others;
    for (const int edge : semi_sharp_) {
      if (!std::binary_search(own_.begin(), own_.end(), edge)) {
        others.push_back(level_.GetEdgeSharpness(edge));
      }
    }
    // The last edge of an open fan that follows a crease stands for the crease's second edge.
    const bool stands_for_crease = fan.followsCrease() && !fan.closed;
    int infinitely_sharp = infinitely_sharp_ - (stands_for_crease ? not_manifold_ : 0);
    for (const int edge : own_) {
      infinitely_sharp -= isInfinitelySharp(level_.GetEdgeSharpness(edge)) &&
                          !(stands_for_crease && level_.IsEdgeNonManifold(edge));
    }
    others.insert(others.end(), std::min(infinitely_sharp, kEdgesOfCorner), kInfinitelySharp);
    return others;
  }

 private:
  static constexpr int kEdgesOfCorner = 3;

  void findSharpEdges(int vertex) {
    vertex_ = vertex;
    semi_sharp_.clear();
    infinitely_sharp_ = not_manifold_ = 0;
    for (const int edge : level_.GetVertexEdges(vertex)) {
      const float sharpness = level_.GetEdgeSharpness(edge);
      if (isSemiSharp(sharpness)) {
        semi_sharp_.push_back(edge);
      } else if (isSharp(sharpness)) {
        ++infinitely_sharp_;
        not_manifold_ += level_.IsEdgeNonManifold(edge);
      }
    }
  }

  void findOwnEdges(const Topology::SplitFan& fan) {
    own_.clear();
    for (const auto& [face, corner] : fan.faces) {
      const auto edges = level_.GetFaceEdges(face);
      own_.push_back(edges[corner]);
      own_.push_back(edges[(corner + edges.size() - 1) % edges.size()]);
    }
    std::sort(own_.begin(), own_.end());
    own_.erase(std::unique(own_.begin(), own_.end()), own_.end());
  }

  const OpenSubdiv::Far::TopologyLevel& level_;
  int vertex_ = -1;
  std::vector<int> semi_sharp_;
  int infinitely_sharp_ = 0;
  int not_manifold_ = 0;  // edges among the infinitely sharp ones
  std::vector<int> own_;  // the edges of the fan, sorted
};

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
  EdgesOfOtherFans edges_of_other_fans(topology_.level());
  InterruptionStride stride;
  for (int vertex = own_points_; vertex < vertex_count_; ++vertex) {
    for (const auto& [face, corner] : topology_.splitFans()[vertex - own_points_].faces) {
      own_corner_vertices_[cornerNumber({face, corner})] = vertex;
    }
    setSplitFan(vertex);
    other_fans_edges_[vertex] = edges_of_other_fans.of(topology_.splitFans()[vertex - own_points_]);
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
  if (split.followsCrease()) {
    crease_ends_[vertex] = split.crease_ends;
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
