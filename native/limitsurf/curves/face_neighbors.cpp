// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/face_neighbors.h"

namespace limitsurf {

std::vector<int> firstPtexFaces(const LimitSurface& surface) {
  std::vector<int> first(static_cast<std::size_t>(surface.mesh().faceCount()), -1);
  for (int face = surface.faceCount() - 1; face >= 0; --face) {
    first[static_cast<std::size_t>(surface.baseFace()[static_cast<std::size_t>(face)])] = face;
  }
  return first;
}

FaceNeighbors::FaceNeighbors(const LimitSurface& surface)
    : surface_(surface), edges_(surface.mesh()), first_ptex_(firstPtexFaces(surface)) {}

FaceNeighbors::Beyond FaceNeighbors::beyond(int face, int k, double x) const {
  const ControlMesh& mesh = surface_.mesh();
  const int base = surface_.baseFace()[static_cast<std::size_t>(face)];
  const int size = mesh.faceSize(base), corner = surface_.corner()[static_cast<std::size_t>(face)];
  const int first = first_ptex_[static_cast<std::size_t>(base)];
  int of_edge = k;
  double fraction = x;
  if (size != 4) {
    // Sides 1 and 2 lead to the n-gon's centre and back; there the neighbours are other sub-faces.
    if (k == 1) {
      return {-1, FaceSide::of(first + (corner + 1) % size, 2), 1 - x};
    }
    if (k == 2) {
      return {-1, FaceSide::of(first + (corner + size - 1) % size, 1), 1 - x};
    }
    of_edge = k == 0 ? corner : (corner + size - 1) % size;
    fraction = k == 0 ? x / 2 : (1 + x) / 2;
  }
  Beyond result;
  result.edge = edges_.ofCorner(mesh.firstCorner(base) + of_edge);
  const Span<MeshEdges::Use> uses = edges_.uses(result.edge);
  if (uses.size() != 2) {
    return result;
  }
  const MeshEdges::Use& other = uses[uses[0].face == base && uses[0].corner == of_edge ? 1 : 0];
  const auto from = [&](const MeshEdges::Use& use) {
    return mesh.faceVertices(use.face)[static_cast<std::size_t>(use.corner)];
  };
  if (surface_.refused().count(other.face) == 0 && from(uses[0]) != from(uses[1])) {
    const EdgeSides sides(mesh, first_ptex_[static_cast<std::size_t>(other.face)], other);
    const double place = (1 - fraction) * sides.count;
    const int half = place < 1 ? 0 : sides.count - 1;
    result.side = sides.sides[half];
    result.x = place - half;
  }
  return result;
}

}  // namespace limitsurf
