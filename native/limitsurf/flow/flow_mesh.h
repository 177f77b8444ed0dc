// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/flow/tangent_planes.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/tessellate/tessellation.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Quads with their vertices on the limit surface, of which every Ptex face has a square grid, and
/// a tangent plane at each vertex.
class FlowMesh {
 public:
  /// A quad in which a location lies, and the weights of its vertices there.
  struct Place {
    std::array<int, 4> vertices;
    std::array<double, 4> weights;
  };

  /// The mesh with half to twice as many quads as `wanted`, or with more if the control mesh has
  /// more, or with fewer if they would be smaller than 1/64 of a face.
  FlowMesh(const LimitSurface& surface, std::int64_t wanted, int threads);

  int vertexCount() const { return static_cast<int>(normals_.size()); }
  std::size_t quadCount() const { return polygons_.face_sizes.size(); }
  std::array<int, 4> quad(std::size_t number) const;
  /// What the surface's lengths are multiplied by in this mesh: a power of two.
  double scale() const { return scale_; }
  Vector3 position(int vertex) const { return polygons_.positions.row(vertex); }
  const Vector3& normal(int vertex) const { return normals_[vertex]; }
  const PlaneBasis& basis(int vertex) const { return bases_[vertex]; }
  double area() const { return area_; }
  /// The length of a quad's side, if all were squares of the same size.
  double meanSide() const;

  /// The place of a location, on a face that has a limit surface.
  Place place(const Location& at) const;

 private:
  void computeNormals();

  Tessellation polygons_;
  std::vector<std::size_t> first_quad_;  // per Ptex face
  std::vector<int> side_;                // per Ptex face: quads along its side, 0 where refused
  std::vector<Vector3> normals_;
  std::vector<PlaneBasis> bases_;
  double scale_ = 1, area_ = 0;
};

}  // namespace limitsurf
