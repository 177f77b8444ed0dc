// SPDX-License-Identifier: Apache-2.0
#include "bench/support/face_classes.h"

#include <cstddef>

namespace limitsurf::bench {
namespace {

enum class VertexClass { regular, interior_ev, boundary_ev, corner };

VertexClass classify(int faces, int edges) {
  if (edges == faces) return faces == 4 ? VertexClass::regular : VertexClass::interior_ev;
  if (faces == 2) return VertexClass::regular;
  return faces == 1 ? VertexClass::corner : VertexClass::boundary_ev;
}

/// The number of edges at each vertex.
std::vector<int> edgeCounts(const MeshArrays& cage) {
  // The edges of a vertex are the outgoing edges of its faces, and those incoming edges that are
  // not outgoing edges of another face.
  std::vector<std::vector<std::int64_t>> out(cage.positions.rows()), in(cage.positions.rows());
  std::size_t first = 0;
  for (const std::int64_t size : cage.face_sizes) {
    for (std::int64_t i = 0; i < size; ++i) {
      const std::int64_t a = cage.face_vertices[first + i];
      const std::int64_t b = cage.face_vertices[first + (i + 1) % size];
      out[a].push_back(b);
      in[b].push_back(a);
    }
    first += size;
  }
  std::vector<int> counts(cage.positions.rows());
  for (std::size_t v = 0; v < counts.size(); ++v) {
    counts[v] = static_cast<int>(out[v].size());
    for (const std::int64_t from : in[v]) {
      bool is_paired = false;
      for (const std::int64_t to : out[v]) is_paired |= to == from;
      counts[v] += !is_paired;
    }
  }
  return counts;
}

}  // namespace

std::vector<ClassifiedFace> classifyFaces(const MeshArrays& cage) {
  std::vector<int> face_counts(cage.positions.rows(), 0);
  std::vector<char> at_polygon(cage.positions.rows(), false);
  std::size_t first = 0;
  for (const std::int64_t size : cage.face_sizes) {
    for (std::int64_t i = 0; i < size; ++i) {
      const std::int64_t v = cage.face_vertices[first + i];
      ++face_counts[v];
      at_polygon[v] |= size != 4;
    }
    first += size;
  }
  const std::vector<int> edge_counts = edgeCounts(cage);

  std::vector<ClassifiedFace> faces;
  first = 0;
  for (const std::int64_t size : cage.face_sizes) {
    if (size != 4) {
      faces.insert(faces.end(), size, {FaceClass::polygon, -1});
    } else {
      ClassifiedFace face{FaceClass::regular, -1};
      bool is_near_polygon = false;
      int ev_count = 0;
      for (int i = 0; i < 4; ++i) {
        const std::int64_t v = cage.face_vertices[first + i];
        is_near_polygon |= at_polygon[v] != 0;
        const VertexClass vertex_class = classify(face_counts[v], edge_counts[v]);
        if (vertex_class == VertexClass::regular) continue;
        ++ev_count;
        face.ev_corner = i;
        face.face_class = vertex_class == VertexClass::interior_ev   ? FaceClass::interior_ev
                          : vertex_class == VertexClass::boundary_ev ? FaceClass::boundary_ev
                                                                     : FaceClass::corner;
      }
      if (is_near_polygon) {
        face = {FaceClass::near_polygon, -1};
      } else if (ev_count > 1) {
        face = {FaceClass::multi_ev, -1};
      }
      faces.push_back(face);
    }
    first += size;
  }
  return faces;
}

std::vector<int> facesOf(const std::vector<ClassifiedFace>& faces, FaceClass face_class) {
  std::vector<int> chosen;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].face_class == face_class) chosen.push_back(static_cast<int>(i));
  }
  return chosen;
}

}  // namespace limitsurf::bench
