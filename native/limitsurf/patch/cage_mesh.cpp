// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/cage_mesh.h"

#include <algorithm>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A vertex takes a small part of the time of an evaluation.
constexpr std::size_t kVerticesPerTask = 16384;

}  // namespace

CageMesh::CageMesh(const ControlMesh& mesh, const Topology& topology)
    : mesh_(mesh),
      level_(topology.level()),
      fans_(topology.splitFans()),
      has_sharpness_(topology.hasSharpness()),
      any_non_manifold_(!fans_.empty()),
      marks_(static_cast<std::size_t>(vertexCount())) {
  for (std::size_t fan = 0; fan < fans_.size(); ++fan) {
    for (const auto& [face, corner] : fans_[fan].faces) {
      fan_of_[cornerNumber({face, corner})] = static_cast<int>(fan);
    }
  }
  parallelFor(marks_.size(), kVerticesPerTask, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      mark(static_cast<int>(v));
    }
  });
}

void CageMesh::mark(int vertex) {
  if (!isSplit(vertex) && any_non_manifold_ && level_.IsVertexNonManifold(vertex)) {
    return;  // it is represented by its fans
  }
  const VertexFan around = fan(vertex);
  std::uint8_t marks = kQuads;
  const auto look = [&](int face) {
    if (faceSize(face) != 4) {
      marks = 0;
    }
  };
  if (isSplit(vertex)) {
    for (const auto& [face, corner] : splitFan(vertex).faces) {
      look(face);
    }
  } else {
    for (const int face : level_.GetVertexFaces(vertex)) {
      look(face);
    }
    if (isRegular(vertex, around)) {
      marks |= kRegular;
    }
  }
  marks_[vertex] = marks;
}

bool CageMesh::isRegular(int vertex, const VertexFan& around) const {
  const int edges = around.closed ? 4 : isInfinitelySharp(around.sharpness) ? 2 : 3;
  if (around.edges() != edges) {
    return false;
  }
  if (!has_sharpness_) {
    return true;
  }
  if (edges != 2 && isSharp(around.sharpness)) {
    return false;
  }
  // The first and the last edge of a boundary are infinitely sharp anyway.
  const auto of_vertex = level_.GetVertexEdges(vertex);
  const int skipped = around.closed ? 0 : 1;
  for (int i = skipped; i < of_vertex.size() - skipped; ++i) {
    if (isSharp(level_.GetEdgeSharpness(of_vertex[i]))) {
      return false;
    }
  }
  return true;
}

VertexFan CageMesh::fan(int vertex) const {
  if (isSplit(vertex)) {
    const Topology::SplitFan& fan = splitFan(vertex);
    return {{fan.faces[0].first, fan.faces[0].second},
            static_cast<int>(fan.faces.size()),
            fan.closed,
            level_.GetVertexSharpness(fan.vertex)};
  }
  const auto faces = level_.GetVertexFaces(vertex);
  VertexFan result{
      {}, faces.size(), !level_.IsVertexBoundary(vertex), level_.GetVertexSharpness(vertex)};
  if (!faces.empty()) {
    result.first = {faces[0], level_.GetVertexFaceLocalIndices(vertex)[0]};
  }
  return result;
}

std::vector<float> CageMesh::edgesOfOtherFans(int vertex) const {
  std::vector<float> result;
  if (!isSplit(vertex)) {
    return result;
  }
  const Topology::SplitFan& fan = splitFan(vertex);
  std::vector<int> own;
  for (const auto& [face, corner] : fan.faces) {
    const auto edges = level_.GetFaceEdges(face);
    own.push_back(edges[corner]);
    own.push_back(edges[(corner + edges.size() - 1) % edges.size()]);
  }
  for (const int edge : level_.GetVertexEdges(fan.vertex)) {
    if (std::find(own.begin(), own.end(), edge) == own.end()) {
      result.push_back(level_.GetEdgeSharpness(edge));
    }
  }
  return result;
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
    result[corner] = !level_.IsVertexBoundary(level_.GetFaceVertices(face)[corner]);
  }
  return result;
}

}  // namespace limitsurf
