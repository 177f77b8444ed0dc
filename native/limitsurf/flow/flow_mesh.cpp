// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/flow/flow_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/interruption_point.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/surface/differential.h"

namespace limitsurf {
namespace {

constexpr int kMostLevels = 6;

int levelsFor(const LimitSurface& surface, std::int64_t wanted) {
  const std::vector<int> sizes = surface.mesh().faceSizes();
  const bool all_quads =
      std::all_of(sizes.begin(), sizes.end(), [](int size) { return size == 4; });
  // a sub-face of an n-gon has half as many quads a side as a quad
  int levels = all_quads ? 0 : 1;
  std::int64_t quads = surface.faceCount();
  while (levels < kMostLevels && 2 * quads < wanted) {
    ++levels;
    quads *= 4;
  }
  return levels;
}

}  // namespace

FlowMesh::FlowMesh(const LimitSurface& surface, std::int64_t wanted, int threads) {
  TessellationOptions options;
  options.threads = threads;
  polygons_ = tessellate(surface, levelsFor(surface, wanted), options);
  std::vector<std::size_t> counts(static_cast<std::size_t>(surface.faceCount()), 0);
  first_quad_.assign(counts.size(), 0);
  for (std::size_t i = polygons_.ptex_face.size(); i-- > 0;) {
    const auto face = static_cast<std::size_t>(polygons_.ptex_face[i]);
    ++counts[face];
    first_quad_[face] = i;
  }
  side_.reserve(counts.size());
  for (const std::size_t count : counts) {
    side_.push_back(static_cast<int>(std::lround(std::sqrt(static_cast<double>(count)))));
  }
  Points& points = polygons_.positions;
  scale_ = scaleToOwnUnit(
      points.rows() > 0 ? (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff()
                        : 0);
  points *= scale_;
  computeNormals();
}

std::array<int, 4> FlowMesh::quad(std::size_t number) const {
  const int* corner = polygons_.face_vertices.data() + 4 * number;
  return {corner[0], corner[1], corner[2], corner[3]};
}

double FlowMesh::meanSide() const {
  return std::sqrt(area_ / static_cast<double>(std::max<std::size_t>(quadCount(), 1)));
}

void FlowMesh::computeNormals() {
  normals_.assign(static_cast<std::size_t>(polygons_.positions.rows()), Vector3::Zero());
  InterruptionStride stride;
  for (std::size_t i = 0; i < quadCount(); ++i) {
    stride.step();
    const std::array<int, 4> v = quad(i);
    const Vector3 across =
        (position(v[2]) - position(v[0])).cross(position(v[3]) - position(v[1])) / 2;
    area_ += across.norm();
    for (const int vertex : v) {
      // around a vertex, faces of a mesh that is not oriented may have opposite orders
      normals_[vertex] += normals_[vertex].dot(across) < 0 ? Vector3(-across) : across;
    }
  }
  bases_.reserve(normals_.size());
  for (Vector3& normal : normals_) {
    stride.step();
    const Vector3 unit = unitDirection(normal);
    normal = unit.allFinite() ? unit : Vector3::UnitZ();
    bases_.push_back(planeBasis(normal));
  }
}

FlowMesh::Place FlowMesh::place(const Location& at) const {
  const int side = side_[at.face];
  const auto cell = [side](double x) { return std::min(static_cast<int>(x * side), side - 1); };
  const int i = cell(at.u), j = cell(at.v);
  const double u = at.u * side - i, v = at.v * side - j;
  return {quad(first_quad_[at.face] + static_cast<std::size_t>(j) * side + i),
          {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}};
}

}  // namespace limitsurf
