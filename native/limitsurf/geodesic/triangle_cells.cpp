// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/triangle_cells.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

constexpr std::int32_t kOne = SurfaceTriangles::Corner::kOne;

}  // namespace

TriangleCells::TriangleCells(const LimitSurface& surface, const std::vector<int>& levels,
                             const SurfaceTriangles& triangles) {
  const ControlMesh& mesh = surface.mesh();
  const std::size_t faces = surface.baseFace().size();
  levels_.resize(faces);
  first_cell_.assign(faces + 1, 0);
  for (std::size_t face = 0; face < faces; ++face) {
    const int base = surface.baseFace()[face];
    const int level = levels[base] - (mesh.faceSize(base) == 4 ? 0 : 1);
    // a refused face needs no cells
    levels_[face] = static_cast<std::uint8_t>(surface.refused().count(base) ? 0 : level);
    first_cell_[face + 1] = first_cell_[face] + (std::size_t{1} << 2 * levels_[face]);
  }
  InterruptionStride stride;
  const auto for_each_cell = [&](std::size_t number, const auto& body) {
    stride.step();
    const int face = triangles.face[number];
    const auto& [a, b, c] = triangles.corners[number];
    const int level = levels_[face];
    const std::int32_t size = kOne >> level;
    const auto range = [&](std::int32_t p, std::int32_t q, std::int32_t r) {
      const std::int32_t low = std::min({p, q, r}), high = std::max({p, q, r});
      return std::pair{std::min(low, kOne - 1) / size, std::max(high - 1, low) / size};
    };
    const auto [u_first, u_last] = range(a.u, b.u, c.u);
    const auto [v_first, v_last] = range(a.v, b.v, c.v);
    for (int v = v_first; v <= v_last; ++v) {
      for (int u = u_first; u <= u_last; ++u) {
        body(first_cell_[face] + (static_cast<std::size_t>(v) << level) + u);
      }
    }
  };
  first_.assign(first_cell_.back() + 1, 0);
  for (std::size_t number = 0; number < triangles.vertices.size(); ++number) {
    for_each_cell(number, [&](std::size_t cell) { ++first_[cell + 1]; });
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  in_cell_.resize(first_.back());
  std::vector<int> end(first_.begin(), first_.end() - 1);
  for (std::size_t number = 0; number < triangles.vertices.size(); ++number) {
    for_each_cell(number,
                  [&](std::size_t cell) { in_cell_[end[cell]++] = static_cast<int>(number); });
  }
}

int TriangleCells::find(const SurfaceTriangles& triangles, const Location& at) const {
  const int level = levels_[at.face], side = 1 << level;
  const auto along = [&](double x) { return std::min(static_cast<int>(x * side), side - 1); };
  const std::size_t cell =
      first_cell_[at.face] + (static_cast<std::size_t>(along(at.v)) << level) + along(at.u);
  return deepest(triangles,
                 Span<int>(in_cell_).subspan(first_[cell], first_[cell + 1] - first_[cell]), at);
}

int deepest(const SurfaceTriangles& triangles, Span<int> numbers, const Location& at) {
  int best = -1;
  double most = -std::numeric_limits<double>::infinity();
  for (const int number : numbers) {
    const std::array<double, 3> weights = barycentric(triangles.corners[number], at.u, at.v);
    const double depth = std::min({weights[0], weights[1], weights[2]});
    if (depth > most) {  // false for triangles without area, whose depth is not finite
      most = depth;
      best = number;
    }
  }
  return best;
}

}  // namespace limitsurf
