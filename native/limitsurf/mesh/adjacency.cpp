// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/adjacency.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A corner takes a small part of the time of an evaluation.
constexpr std::size_t kPerTask = 16384;

}  // namespace

class Adjacency::Builder {
 public:
  Builder(const ControlMesh& mesh, Adjacency& made)
      : mesh_(mesh), made_(made), vertices_(mesh.faceVertices()) {}

  bool build() {
    made_.findFaces(mesh_);
    listCorners();
    made_.twins.resize(vertices_.size());
    forEach(vertices_.size(), [&](int corner) { findTwin(corner); });
    if (!manifold_) {
      return false;
    }
    made_.fans.resize(static_cast<std::size_t>(mesh_.vertexCount()));
    forEach(made_.fans.size(), [&](int vertex) { findFan(vertex); });
    return manifold_;
  }

 private:
  /// Calls visit(i) for i from 0 to count - 1, on all cores, until something is not manifold.
  template <typename Visit>
  void forEach(std::size_t count, const Visit& visit) {
    parallelFor(count, kPerTask, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && manifold_.load(std::memory_order_relaxed); ++i) {
        visit(static_cast<int>(i));
      }
    });
  }

  int next(int corner) const { return made_.next(mesh_, corner); }
  int previous(int corner) const { return made_.previous(mesh_, corner); }

  /// Chains the corners of each vertex, from the last one to the first.
  void listCorners() {
    const auto count = static_cast<std::size_t>(mesh_.vertexCount());
    last_.assign(count, -1);
    counts_.assign(count, 0);
    before_.resize(vertices_.size());
    InterruptionStride stride;
    for (int corner = 0; corner < static_cast<int>(vertices_.size()); ++corner) {
      if (corner % 64 == 0) {
        stride.step();
      }
      const int vertex = vertices_[corner];
      before_[corner] = last_[vertex];
      last_[vertex] = corner;
      ++counts_[vertex];
    }
  }

  void findTwin(int corner) {
    const int begin = vertices_[corner], end = vertices_[next(corner)];
    int same = 0, opposite = 0, twin = -1;
    const bool at_begin = counts_[begin] < counts_[end];
    const int far = at_begin ? end : begin;
    for (int other = last_[at_begin ? begin : end]; other >= 0; other = before_[other]) {
      if (vertices_[next(other)] == far) {  // the edge leaves this corner
        if (at_begin) {
          ++same;
        } else {
          ++opposite;
          twin = other;
        }
      }
      const int arriving = previous(other);
      if (vertices_[arriving] == far) {
        if (at_begin) {
          ++opposite;
          twin = arriving;
        } else {
          ++same;
        }
      }
    }
    made_.twins[corner] = twin;
    // A face that names a vertex twice has two corners there, which two fans or one edge contain.
    if (same > 1 || opposite > 1) {
      manifold_ = false;
    }
  }

  void findFan(int vertex) {
    Fan& fan = made_.fans[vertex];
    fan.faces = counts_[vertex];
    int previous_face = -1;
    for (int corner = last_[vertex]; corner >= 0; corner = before_[corner]) {
      if (made_.twins[corner] < 0) {
        fan.first = corner;
        fan.closed = false;
      } else if (fan.closed) {
        fan.first = corner;
      }
      const int face = made_.face(corner);
      if (face == previous_face) {
        manifold_ = false;
        return;
      }
      previous_face = face;
    }
    int corner = fan.first;
    for (int i = 1; i < fan.faces; ++i) {
      corner = made_.twins[previous(corner)];
      if (corner < 0 || corner == fan.first) {
        manifold_ = false;
        return;
      }
    }
  }

  const ControlMesh& mesh_;
  Adjacency& made_;
  const std::vector<int>& vertices_;  // per corner
  std::vector<int> last_, counts_;    // per vertex: its last corner, and how many it has
  std::vector<int> before_;           // per corner: the same vertex's corner before it
  std::atomic<bool> manifold_{true};
};

void Adjacency::findFaces(const ControlMesh& mesh) {
  int quads = 0;
  while (quads < mesh.faceCount() && mesh.faceSize(quads) == 4) {
    ++quads;
  }
  if (quads == mesh.faceCount()) {
    return;
  }
  face_of_corner.resize(mesh.faceVertices().size());
  parallelFor(static_cast<std::size_t>(mesh.faceCount()), kPerTask, 0,
              [&](std::size_t begin, std::size_t end) {
                for (int at = static_cast<int>(begin); at < static_cast<int>(end); ++at) {
                  std::fill_n(face_of_corner.begin() + mesh.firstCorner(at), mesh.faceSize(at), at);
                }
              });
}

int Adjacency::side(const ControlMesh& mesh, int begin, int end) const {
  const std::vector<int>& vertices = mesh.faceVertices();
  const Fan& fan = fans[begin];
  int corner = fan.first;
  for (int i = 0; i < fan.faces; ++i) {
    if (vertices[next(mesh, corner)] == end) {
      return corner;
    }
    const int arriving = previous(mesh, corner);
    if (vertices[arriving] == end) {
      return arriving;
    }
    corner = twins[arriving];
  }
  throw std::logic_error("an edge that the mesh does not have");
}

std::optional<Adjacency> Adjacency::ofManifold(const ControlMesh& mesh) {
  std::optional<Adjacency> made(std::in_place);
  if (!Builder(mesh, *made).build()) {
    made.reset();
  }
  return made;
}

}  // namespace limitsurf
