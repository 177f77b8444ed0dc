// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/surface_triangles.h"

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/tessellate/tessellation.h"

namespace limitsurf {
namespace {

using PolygonCorner = Tessellation::Corner;
constexpr int kSteps = PolygonCorner::kSteps;

/// The edge of the control mesh, as the corner of the base face from which it leaves, on which a
/// side of a polygon lies; -1 for sides inside the face.
int edgeOfSide(const PolygonCorner& a, const PolygonCorner& b, int size, int corner) {
  if (a.v == 0 && b.v == 0) {
    return size == 4 ? 0 : corner;
  }
  if (a.u == 0 && b.u == 0) {
    return size == 4 ? 3 : (corner + size - 1) % size;
  }
  if (size == 4 && a.u == kSteps && b.u == kSteps) {
    return 1;
  }
  return size == 4 && a.v == kSteps && b.v == kSteps ? 2 : -1;
}

SurfaceTriangles::Corner scaled(const PolygonCorner& corner) {
  constexpr std::int32_t kScale = SurfaceTriangles::Corner::kOne / kSteps;
  return {corner.u * kScale, corner.v * kScale};
}

}  // namespace

SurfaceTriangles surfaceTriangles(const LimitSurface& surface, const std::vector<int>& levels,
                                  const EdgeList& cuts, int threads, const Progress& progress) {
  const ControlMesh& mesh = surface.mesh();
  const std::vector<std::uint8_t> cut_corners = cutCorners(mesh, cuts);
  TessellationOptions options;
  options.threads = threads;
  options.progress = progress;
  const Tessellation polygons = tessellate(surface, levels, options);
  SurfaceTriangles made;
  made.points.reserve(static_cast<std::size_t>(polygons.positions.rows()));
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < polygons.positions.rows(); ++row) {
    stride.step();
    made.points.emplace_back(polygons.positions.row(row));
  }
  std::size_t first = 0;
  for (std::size_t polygon = 0; polygon < polygons.face_sizes.size(); ++polygon) {
    stride.step();
    const int size = polygons.face_sizes[polygon];
    const int* point = polygons.face_vertices.data() + first;
    const PolygonCorner* corner = polygons.corners.data() + first;
    first += static_cast<std::size_t>(size);
    const auto length = [&](int a, int b) {
      return (made.points[point[a]] - made.points[point[b]]).squaredNorm();
    };
    // quads are divided by their shorter diagonal
    const int turn = size == 4 && length(1, 3) < length(0, 2) ? 1 : 0;
    const int face = polygons.base_face[polygon];
    const int ptex_face = polygons.ptex_face[polygon];
    for (int k = 0; k + 2 < size; ++k) {
      const std::array<int, 3> at = {turn, turn + k + 1, (turn + k + 2) % size};
      reserveMore(made.vertices, 1);
      reserveMore(made.corners, 1);
      reserveMore(made.face, 1);
      reserveMore(made.is_cut, 1);
      made.vertices.push_back({point[at[0]], point[at[1]], point[at[2]]});
      made.corners.push_back({scaled(corner[at[0]]), scaled(corner[at[1]]), scaled(corner[at[2]])});
      made.face.push_back(ptex_face);
      std::array<std::uint8_t, 3>& is_cut = made.is_cut.emplace_back();
      for (int side = 0; side < 3; ++side) {
        const int edge = edgeOfSide(corner[at[side]], corner[at[(side + 1) % 3]],
                                    mesh.faceSize(face), surface.corner()[ptex_face]);
        is_cut[side] = edge >= 0 && cut_corners[mesh.firstCorner(face) + edge];
      }
    }
  }
  return made;
}

std::array<double, 3> barycentric(const std::array<SurfaceTriangles::Corner, 3>& corners, double u,
                                  double v) {
  u *= SurfaceTriangles::Corner::kOne;
  v *= SurfaceTriangles::Corner::kOne;
  const auto area = [](double au, double av, double bu, double bv, double cu, double cv) {
    return (bu - au) * (cv - av) - (cu - au) * (bv - av);
  };
  const auto& [a, b, c] = corners;
  const double whole = area(a.u, a.v, b.u, b.v, c.u, c.v);
  const double of_a = area(u, v, b.u, b.v, c.u, c.v);
  const double of_b = area(a.u, a.v, u, v, c.u, c.v);
  return {of_a / whole, of_b / whole, (whole - of_a - of_b) / whole};
}

}  // namespace limitsurf
