// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/geodesic_tracer.h"

#include "limitsurf/curves/face_neighbors.h"
#include "limitsurf/curves/geodesic_walk.h"
#include "limitsurf/curves/side_cubics.h"

namespace limitsurf {

struct GeodesicTracer::Data {
  Data(const LimitSurface& surface, int threads) : ground(surface, threads) {}

  GeodesicGround ground;
};

GeodesicTracer::GeodesicTracer(const LimitSurface& surface, int threads)
    : data_(std::make_unique<Data>(surface, threads)) {}

GeodesicTracer::~GeodesicTracer() = default;
GeodesicTracer::GeodesicTracer(GeodesicTracer&&) noexcept = default;
GeodesicTracer& GeodesicTracer::operator=(GeodesicTracer&&) noexcept = default;

GeodesicTracer::Path GeodesicTracer::trace(const Location& from, const Vector3& direction,
                                           const std::vector<double>& lengths,
                                           const std::vector<bool>* targets) const {
  Path path;
  GeodesicWalk walk(data_->ground, targets);
  const double scale = data_->ground.patches.scale();
  bool goes_on = walk.start(from, direction);
  for (std::size_t i = 0; i < lengths.size() && goes_on; ++i) {
    goes_on = walk.go(scale * lengths[i]);
    if (goes_on) {
      path.stops.push_back(walk.stop());
      path.stops.back().position /= scale;
    }
  }
  path.length = walk.length() / scale;
  path.hit = walk.hit();
  return path;
}

std::vector<bool> GeodesicTracer::targets(const std::vector<std::pair<int, int>>& edges) const {
  const MeshEdges& of_mesh = data_->ground.neighbors.edges();
  std::vector<bool> flags(static_cast<std::size_t>(of_mesh.count()), false);
  for (const auto& [a, b] : edges) {
    const int edge = of_mesh.find(a, b);
    if (edge >= 0) {
      flags[static_cast<std::size_t>(edge)] = true;
    }
  }
  return flags;
}

}  // namespace limitsurf
