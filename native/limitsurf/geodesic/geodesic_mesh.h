// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limitsurf/geodesic/cut_edges.h"
#include "limitsurf/geodesic/surface_triangles.h"
#include "limitsurf/geodesic/triangle_cells.h"
#include "limitsurf/progress.h"
#include "limitsurf/search/polylines.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// What no way along a surface crosses.
struct GeodesicCuts {
  EdgeList edges{};    ///< of the control mesh
  Polylines curves{};  ///< on the surface or near it; see curve_cuts.h
};

/// Triangles with their vertices on the limit surface, for distances along it. Along cuts they do
/// not hang together: the vertices there exist once for each side. The same is true where sheets of
/// faces touch in a vertex only.
class GeodesicMesh {
 public:
  /// `levels` are those of tessellate(), one for each face of the control mesh. Throws MeshError
  /// for cuts that are no edges of the mesh.
  GeodesicMesh(const LimitSurface& surface, const std::vector<int>& levels,
               const GeodesicCuts& cuts, int threads, const Progress& progress);

  int vertexCount() const { return static_cast<int>(triangles_.points.size()); }
  std::size_t triangleCount() const { return triangles_.vertices.size(); }
  const Vector3& position(int vertex) const { return triangles_.points[vertex]; }
  const std::array<int, 3>& triangle(int number) const { return triangles_.vertices[number]; }
  /// The triangles around a vertex.
  Span<int> trianglesAt(int vertex) const {
    return Span<int>(around_).subspan(first_around_[vertex],
                                      first_around_[vertex + 1] - first_around_[vertex]);
  }
  /// Where a corner of a triangle lies on the triangle's own Ptex face.
  Location at(int triangle, int corner) const {
    constexpr double kPart = 1. / SurfaceTriangles::Corner::kOne;
    const SurfaceTriangles::Corner place = triangles_.corners[triangle][corner];
    return {triangles_.face[triangle], place.u * kPart, place.v * kPart};
  }
  /// The barycentric coordinates of a location on the triangle's Ptex face.
  std::array<double, 3> weights(int triangle, const Location& at) const {
    return barycentric(triangles_.corners[triangle], at.u, at.v);
  }
  struct Neighbor {
    int vertex;
    double distance;
  };
  /// A triangle at a vertex: its other two vertices, as numbers of neighbors, and their distance.
  /// Where triangles are long and thin there are also better shaped ones (delaunay_flips.h).
  struct Wedge {
    int b, c;
    double distance;
  };
  /// The vertices that share a side of a wedge with a vertex. One may be listed more than once.
  Span<Neighbor> neighborsAt(int vertex) const {
    return Span<Neighbor>(neighbors_)
        .subspan(first_neighbor_[vertex], first_neighbor_[vertex + 1] - first_neighbor_[vertex]);
  }
  Span<Wedge> wedgesAt(int vertex) const {
    return Span<Wedge>(wedges_).subspan(first_wedge_[vertex],
                                        first_wedge_[vertex + 1] - first_wedge_[vertex]);
  }
  double distance(int a, int b) const { return (position(a) - position(b)).norm(); }
  /// The triangle in which a location lies, on a face that has a limit surface.
  int triangleAt(const Location& at) const { return cells_.find(triangles_, at); }
  /// The triangle over which a position lies, looked for from another one on, across no cuts. A
  /// location may lie beside the triangle in which its (u, v) are, because equal steps of them are
  /// not equally long on the surface.
  int triangleUnder(const Vector3& position, int triangle) const;

 private:
  /// The barycentric coordinates of the point of a triangle's plane that is closest to a position.
  std::array<double, 3> weightsUnder(const Vector3& position, int triangle) const;
  /// Another triangle with both vertices, or -1.
  int beyond(int triangle, int a, int b) const;
  void hangTogether();
  void listAround();
  void listNeighbors();

  SurfaceTriangles triangles_;  // whose points are the vertices
  TriangleCells cells_;
  std::vector<int> first_around_, around_;
  std::vector<int> first_wedge_;
  std::vector<Wedge> wedges_;
  std::vector<int> first_neighbor_;
  std::vector<Neighbor> neighbors_;
};

}  // namespace limitsurf
