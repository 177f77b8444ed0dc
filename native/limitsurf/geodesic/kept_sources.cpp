// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/kept_sources.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <queue>
#include <utility>

#include "limitsurf/curves/point_grid.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// Sources are looked for within so many times the longest side at a vertex, and farther where that
/// side is so much longer than such sides are on average.
constexpr double kLookFor = 4, kLookFarther = 16, kUnusual = 2;
/// A triangle is long if the square of its longest side exceeds so many times twice its area: if it
/// is about six times as long as wide.
constexpr double kLong = 6;

/// What is known of the triangles at each vertex.
struct Sizes {
  std::vector<double> side;           ///< the longest one
  std::vector<std::uint8_t> is_long;  ///< whether one of the triangles is

  explicit Sizes(const GeodesicMesh& mesh)
      : side(static_cast<std::size_t>(mesh.vertexCount()), 0), is_long(side.size(), 0) {
    InterruptionStride stride;
    for (int triangle = 0; triangle < static_cast<int>(mesh.triangleCount()); ++triangle) {
      stride.step();
      const auto& [a, b, c] = mesh.triangle(triangle);
      const Vector3 to_b = mesh.position(b) - mesh.position(a),
                    to_c = mesh.position(c) - mesh.position(a);
      const double longest = std::max({to_b.norm(), to_c.norm(), mesh.distance(b, c)});
      const double unit = 1 / longest;  // products stay in range
      const bool long_one = kLong * (unit * to_b).cross(unit * to_c).norm() < 1;
      for (const int vertex : {a, b, c}) {
        side[vertex] = std::max(side[vertex], longest);
        is_long[vertex] |= long_one;
      }
    }
  }
};

/// The sources near places in space. Distances along the surface are not shorter.
class SourcesInSpace {
 public:
  SourcesInSpace(const std::vector<MeshPlace>& sources, double cell)
      : positions_(positionsOf(sources)), grid_(positions_, cell) {}

  /// The distances of those that are at most `reach` away, the shortest first.
  const std::vector<double>& within(double reach, const Vector3& place) {
    grid_.near(place, reach, near_);
    distances_.clear();
    for (const int source : near_) {
      const double distance = (positions_.row(source).transpose() - place).norm();
      if (distance <= reach) {
        distances_.push_back(distance);
      }
    }
    std::sort(distances_.begin(), distances_.end());
    return distances_;
  }

 private:
  static Points positionsOf(const std::vector<MeshPlace>& sources) {
    Points positions(static_cast<Eigen::Index>(sources.size()), 3);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      positions.row(static_cast<Eigen::Index>(i)) = sources[i].position;
    }
    return positions;
  }

  Points positions_;
  PointGrid grid_;
  std::vector<int> near_;
  std::vector<double> distances_;
};

}  // namespace

std::vector<int> keptSources(const GeodesicMesh& mesh, const std::vector<MeshPlace>& sources,
                             int count, int spare) {
  std::vector<int> kept(static_cast<std::size_t>(mesh.vertexCount()), count + spare);
  if (sources.size() <= static_cast<std::size_t>(count + spare)) {
    return kept;
  }
  const Sizes sizes(mesh);
  const double largest = *std::max_element(sizes.side.begin(), sizes.side.end());
  if (!(largest > 0)) {
    return kept;
  }
  SourcesInSpace in_space(sources, kLookFor * largest);
  // Which sources each vertex needs: those within this distance.
  std::vector<double> reach(kept.size(), 0);
  std::priority_queue<std::pair<double, int>> farthest_first;
  const double mean = std::accumulate(sizes.side.begin(), sizes.side.end(), 0.) /
                      static_cast<double>(sizes.side.size());
  const auto wanted = static_cast<std::size_t>(count);
  InterruptionStride stride;
  for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
    stride.step();
    const double side = sizes.side[vertex];
    const bool is_unusual = side > kUnusual * mean;
    if (!is_unusual && !sizes.is_long[vertex]) {
      continue;
    }
    const double look_for = is_unusual ? kLookFarther : kLookFor;
    const std::vector<double>& distances = in_space.within(look_for * side, mesh.position(vertex));
    if (distances.size() < wanted) {
      continue;
    }
    const double needed = distances[wanted - 1] + 2 * side;
    const auto end = std::upper_bound(distances.begin(), distances.end(), needed);
    if (end - distances.begin() > count + spare) {
      reach[vertex] = needed;
      farthest_first.emplace(needed, vertex);
    }
  }
  while (!farthest_first.empty()) {
    stride.step();
    const auto [here, vertex] = farthest_first.top();
    farthest_first.pop();
    if (here < reach[vertex]) {
      continue;
    }
    const std::size_t needed = in_space.within(here, mesh.position(vertex)).size();
    kept[vertex] = std::clamp(static_cast<int>(needed), count + spare, kMostKept);
    for (const GeodesicMesh::Neighbor& next : mesh.neighborsAt(vertex)) {
      const double there = here - next.distance;
      if (there > reach[next.vertex]) {
        reach[next.vertex] = there;
        farthest_first.emplace(there, next.vertex);
      }
    }
  }
  return kept;
}

}  // namespace limitsurf
