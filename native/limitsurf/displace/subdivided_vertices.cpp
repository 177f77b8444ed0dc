// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/displace/subdivided_vertices.h"

#include <algorithm>
#include <limits>
#include <string>

namespace limitsurf {
namespace {

/// The key of an edge, made of its vertices.
std::uint64_t edgeKey(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
         static_cast<std::uint32_t>(std::max(a, b));
}

std::vector<std::uint64_t> edgeKeys(const ControlMesh& mesh) {
  std::vector<std::uint64_t> keys;
  keys.reserve(mesh.faceVertices().size());
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = mesh.faceVertices(face);
    for (std::size_t c = 0; c < vertices.size(); ++c) {
      keys.push_back(edgeKey(vertices[c], vertices[(c + 1) % vertices.size()]));
    }
  }
  return keys;
}

}  // namespace

SubdividedVertices::SubdividedVertices(const ControlMesh& mesh, int levels)
    : mesh_(mesh), per_edge_(1 << levels) {
  const std::vector<std::uint64_t> keys = edgeKeys(mesh);
  std::vector<std::uint64_t> edges = keys;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const std::uint64_t key : keys) {
    const auto place = std::lower_bound(edges.begin(), edges.end(), key);
    edge_at_.push_back(static_cast<int>(place - edges.begin()));
  }
  std::int64_t next =
      mesh.vertexCount() + static_cast<std::int64_t>(edges.size()) * (per_edge_ - 1);
  const std::int64_t inner = per_edge_ - 1, half_inner = per_edge_ / 2 - 1;
  for (int face = 0; face < mesh.faceCount(); ++face) {
    if (next > std::numeric_limits<int>::max()) {
      throw MeshError(std::to_string(levels) + " subdivisions of " +
                      std::to_string(mesh.faceCount()) + " faces have too many vertices");
    }
    first_within_.push_back(static_cast<int>(next));
    const int size = mesh.faceSize(face);
    next += size == 4 ? inner * inner : 1 + size * half_inner * (1 + half_inner);
  }
}

int SubdividedVertices::at(int face, int part, int i, int j) const {
  return mesh_.faceSize(face) == 4 ? onQuad(face, i, j) : onPart(face, part, i, j);
}

int SubdividedVertices::onEdge(int face, int edge, int step) const {
  const Span<int> vertices = mesh_.faceVertices(face);
  const int from = vertices[edge], to = vertices[(edge + 1) % vertices.size()];
  if (step == 0 || step == per_edge_) {
    return step == 0 ? from : to;
  }
  const int upwards = from < to ? step : per_edge_ - step;
  const int index = edge_at_[static_cast<std::size_t>(mesh_.firstCorner(face) + edge)];
  return mesh_.vertexCount() + index * (per_edge_ - 1) + upwards - 1;
}

int SubdividedVertices::onQuad(int face, int i, int j) const {
  const int side = per_edge_;
  if (j == 0) {
    return onEdge(face, 0, i);
  }
  if (i == side) {
    return onEdge(face, 1, j);
  }
  if (j == side) {
    return onEdge(face, 2, side - i);
  }
  if (i == 0) {
    return onEdge(face, 3, side - j);
  }
  return first_within_[face] + (j - 1) * (side - 1) + i - 1;
}

int SubdividedVertices::onPart(int face, int part, int i, int j) const {
  const int size = mesh_.faceSize(face), side = per_edge_ / 2, inner = side - 1;
  const int before = (part + size - 1) % size, centre = first_within_[face];
  const auto onLine = [&](int edge, int step) { return centre + 1 + edge * inner + step - 1; };
  if (j == 0) {
    return onEdge(face, part, i);
  }
  if (i == 0) {
    return onEdge(face, before, per_edge_ - j);
  }
  if (i == side && j == side) {
    return centre;
  }
  if (j == side) {
    return onLine(before, i);  // from the middle of an edge to the centre
  }
  if (i == side) {
    return onLine(part, j);
  }
  return centre + 1 + (size + part * inner) * inner + (j - 1) * inner + i - 1;
}

}  // namespace limitsurf
