// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limitsurf/geodesic/cut_edges.h"
#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/tessellate/tessellation.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Triangles with their vertices on the limit surface, for distances along it. Along cut edges of
/// the control mesh they do not hang together: the vertices there exist once for each side. The
/// same is true where sheets of faces touch in a vertex only.
class GeodesicMesh {
 public:
  /// `levels` are those of tessellate(), one for each face of the control mesh. Throws MeshError
  /// for cuts that are no edges of the mesh.
  GeodesicMesh(const LimitSurface& surface, const std::vector<int>& levels, const EdgeList& cuts,
               int threads, const Progress& progress);

  int vertexCount() const { return static_cast<int>(positions_.size()); }
  std::size_t triangleCount() const { return triangles_.size(); }
  const Vector3& position(int vertex) const { return positions_[vertex]; }
  const std::array<int, 3>& triangle(int number) const { return triangles_[number]; }
  /// The triangles around a vertex.
  Span<int> trianglesAt(int vertex) const {
    return Span<int>(around_).subspan(first_around_[vertex],
                                      first_around_[vertex + 1] - first_around_[vertex]);
  }
  double distance(int a, int b) const { return (positions_[a] - positions_[b]).norm(); }
  /// The triangle in which a location lies, on a face that has a limit surface.
  int triangleAt(const Location& at) const;

 private:
  using Corner = Tessellation::Corner;

  void triangulate(const LimitSurface& surface, const Tessellation& polygons,
                   const std::vector<std::uint8_t>& cut_corners);
  void hangTogether(const Tessellation& polygons, const std::vector<std::uint8_t>& is_cut);
  void listAround();
  void listCells(const LimitSurface& surface, const std::vector<int>& levels,
                 const std::vector<int>& face_of_triangle);

  std::vector<Vector3> positions_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<Corner, 3>> corners_;  // (u, v) of the triangles' vertices
  std::vector<int> first_around_, around_;

  // Each Ptex face is divided into 2^n x 2^n cells, which list the triangles that reach into them.
  std::vector<std::uint8_t> cell_levels_;  // per Ptex face: n
  std::vector<std::size_t> first_cell_;    // per Ptex face
  std::vector<int> first_in_cell_, in_cell_;
};

}  // namespace limitsurf
