// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/mesh_edges.h"

#include <algorithm>

#include "limitsurf/interruptible_sort.h"

namespace limitsurf {
namespace {

std::uint64_t keyOf(std::int64_t a, std::int64_t b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

struct Corner {
  std::uint64_t vertices;
  int number;
  MeshEdges::Use use;
};

}  // namespace

MeshEdges::MeshEdges(const ControlMesh& mesh) {
  const std::size_t all = mesh.faceVertices().size();
  std::vector<Corner> corners;
  corners.reserve(all);
  InterruptionStride stride;
  for (int face = 0; face < mesh.faceCount(); ++face) {
    stride.step();
    const Span<int> of_face = mesh.faceVertices(face);
    for (std::size_t i = 0; i < of_face.size(); ++i) {
      const int a = of_face[i], b = of_face[(i + 1) % of_face.size()];
      if (a != b) {
        const int corner = static_cast<int>(i);
        corners.push_back({keyOf(a, b), mesh.firstCorner(face) + corner, {face, corner}});
      }
    }
  }
  sortInterruptibly(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.number < b.number;
  });
  // The edges by their first corner: `first` is the place of that corner among the sorted ones.
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    stride.step();
    if (i == 0 || corners[i].vertices != corners[i - 1].vertices) {
      first.push_back(i);
    }
  }
  keys_.resize(first.size());
  std::vector<std::size_t> order(first.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  sortInterruptibly(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return corners[first[a]].number < corners[first[b]].number;
  });
  of_corner_.assign(all, -1);
  first_use_.push_back(0);
  for (const std::size_t place : order) {
    stride.step();
    const int edge = count();
    const Corner& at = corners[first[place]];
    const Span<int> of_face = mesh.faceVertices(at.use.face);
    const auto corner = static_cast<std::size_t>(at.use.corner);
    vertices_.push_back({of_face[corner], of_face[(corner + 1) % of_face.size()]});
    keys_[place] = {at.vertices, edge};
    const std::size_t end = place + 1 < first.size() ? first[place + 1] : corners.size();
    for (std::size_t i = first[place]; i < end; ++i) {
      uses_.push_back(corners[i].use);
      of_corner_[static_cast<std::size_t>(corners[i].number)] = edge;
    }
    first_use_.push_back(static_cast<int>(uses_.size()));
  }
}

int MeshEdges::find(std::int64_t a, std::int64_t b) const {
  constexpr std::int64_t kMost = std::int64_t{1} << 31;
  if (a < 0 || b < 0 || a >= kMost || b >= kMost) {
    return -1;
  }
  const std::uint64_t wanted = keyOf(a, b);
  const auto found =
      std::lower_bound(keys_.begin(), keys_.end(), wanted,
                       [](const Key& key, std::uint64_t value) { return key.vertices < value; });
  return found != keys_.end() && found->vertices == wanted ? found->edge : -1;
}

}  // namespace limitsurf
