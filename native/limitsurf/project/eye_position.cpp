// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include "limitsurf/project/projection.h"
#include "limitsurf/project/projector.h"

namespace limitsurf {
namespace {

/// Whether every edge has two faces and no face is refused.
bool isClosed(const LimitSurface& surface) {
  if (!surface.refused().empty()) {
    return false;
  }
  std::map<std::pair<int, int>, int> faces;
  const ControlMesh& mesh = surface.mesh();
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = mesh.faceVertices(face);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int a = vertices[i], b = vertices[(i + 1) % vertices.size()];
      ++faces[std::minmax(a, b)];
    }
  }
  for (const auto& edge : faces) {
    if (edge.second != 2) {
      return false;
    }
  }
  return true;
}

/// The directions to the corners, edges and faces of a cube.
Points directionsAround() {
  Points directions(26, 3);
  Eigen::Index row = 0;
  for (int i = 0; i < 27; ++i) {
    if (i != 13) {
      const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
      directions.row(row++) << x, y, z;
    }
  }
  return directions;
}

}  // namespace

bool eyeIsInside(const LimitSurface& surface, const SurfaceSearch& search,
                 const Eigen::Matrix4d& matrix, int threads) {
  const Projector projector(matrix, surface);
  if (!projector.hasEye()) {
    return false;
  }
  const Points directions = directionsAround();
  const Hits hits = search.rayCast(projector.eye().transpose().replicate(directions.rows(), 1),
                                   directions, std::numeric_limits<double>::infinity(), threads);
  Eigen::Index backs = 0;
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    backs += hits.at[static_cast<std::size_t>(i)].face >= 0 &&
             hits.normal.row(i).dot(directions.row(i)) > 0;
  }
  return isClosed(surface) ? 2 * backs > directions.rows() : backs == directions.rows();
}

}  // namespace limitsurf
