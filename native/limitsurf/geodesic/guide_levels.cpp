// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/guide_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limitsurf {
namespace {

/// Faces are divided at least once, and up to kMostLevel until there are kQuads of them.
constexpr int kLeastLevel = 1, kMostLevel = 6;
constexpr double kQuads = 1 << 14;
/// Curves that cut are laid onto the triangles' sides as chords. The smaller the triangles are, the
/// closer to a curve places may be and still be told to lie on the right side.
constexpr double kQuadsWithCurves = 1 << 16;
/// The least level where guides or cuts are near: distances are shorter than a face there, or ways
/// bend.
constexpr int kLeastLevelNearby = 2;
/// Faces with many guides are divided further, until a quad has at most this share of a guide.
constexpr double kGuidesPerQuad = 1. / 4;
constexpr int kMostLevelWithGuides = 9;

/// Tells for each vertex whether it belongs to a face with guides or to an edge that is cut.
std::vector<std::uint8_t> nearbyVertices(const ControlMesh& mesh,
                                         const std::vector<int>& guides_of_face,
                                         const EdgeList& cuts) {
  std::vector<std::uint8_t> is_near(static_cast<std::size_t>(mesh.vertexCount()));
  for (int face = 0; face < mesh.faceCount(); ++face) {
    if (guides_of_face[face] > 0) {
      for (const int vertex : mesh.faceVertices(face)) {
        is_near[vertex] = true;
      }
    }
  }
  const std::vector<std::uint8_t> is_cut = cutCorners(mesh, cuts);
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = mesh.faceVertices(face);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (is_cut[mesh.firstCorner(face) + k]) {
        is_near[vertices[k]] = is_near[vertices[(k + 1) % vertices.size()]] = true;
      }
    }
  }
  return is_near;
}

}  // namespace

std::vector<int> guideLevels(const LimitSurface& surface, const LocationBatch& guides,
                             const GeodesicCuts& cuts) {
  const ControlMesh& mesh = surface.mesh();
  const bool has_curves = cuts.curves.points.rows() > 0;  // which may come near any face
  const double quads_wanted = has_curves ? kQuadsWithCurves : kQuads;
  int level = has_curves ? kLeastLevelNearby : kLeastLevel;
  while (level < kMostLevel &&
         std::ldexp(static_cast<double>(mesh.faceCount()), 2 * level) < quads_wanted) {
    ++level;
  }
  std::vector<int> guides_of_face(static_cast<std::size_t>(mesh.faceCount()));
  for (std::size_t guide = 0; guide < guides.size(); ++guide) {
    ++guides_of_face[surface.baseFace()[guides[guide].face]];
  }
  const std::vector<std::uint8_t> is_near = nearbyVertices(mesh, guides_of_face, cuts.edges);
  std::vector<int> levels(guides_of_face.size(), level);
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = mesh.faceVertices(face);
    if (std::any_of(vertices.begin(), vertices.end(),
                    [&](int vertex) { return is_near[vertex] != 0; })) {
      levels[face] = std::max(level, kLeastLevelNearby);
    }
    const double quads = guides_of_face[face] / kGuidesPerQuad;
    while (levels[face] < kMostLevelWithGuides && std::ldexp(1., 2 * levels[face]) < quads) {
      ++levels[face];
    }
  }
  return levels;
}

}  // namespace limitsurf
