// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/limit_surface.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

LimitSurface::Data::Data(ControlMesh control_mesh)
    : mesh(std::move(control_mesh)),
      positions(mesh.positions()),
      tiles(std::make_shared<TiledSurface>(mesh)),
      ptex(tiles->ptex),
      refused(tiles->refused),
      table(tiles->table),
      pose(table) {
  pose.set(positions, 0);
}

VertexApproach LimitSurface::Data::approachTo(const TileLocation& at) const {
  return vertexApproach(table, pose, static_cast<int>(at.tile.index), at.turns);
}

LimitSurface::LimitSurface(ControlMesh mesh) : data_(std::make_unique<Data>(std::move(mesh))) {}
LimitSurface::~LimitSurface() = default;
LimitSurface::LimitSurface(LimitSurface&&) noexcept = default;
LimitSurface& LimitSurface::operator=(LimitSurface&&) noexcept = default;

const ControlMesh& LimitSurface::mesh() const { return data_->mesh; }
const Points& LimitSurface::positions() const { return data_->positions; }
int LimitSurface::faceCount() const { return static_cast<int>(data_->ptex.base_face.size()); }
const std::vector<int>& LimitSurface::baseFace() const { return data_->ptex.base_face; }
const std::vector<int>& LimitSurface::corner() const { return data_->ptex.corner; }
const std::map<int, std::string>& LimitSurface::refused() const { return data_->refused; }

void LimitSurface::setPositions(Points positions, int threads) {
  checkThreads(threads);
  checkPositions(positions, data_->mesh.vertexCount(), threads);
  data_->pose.set(positions, threads);
  data_->positions = std::move(positions);
}

bool LimitSurface::isPosed() const { return data_->pose.isSet(); }

LocationBatch LimitSurface::checkLocations(const LocationBatch& at, int threads) const {
  checkThreads(threads);
  return data_->tiles->checked(at, threads);
}

std::vector<Location> LimitSurface::vertexLocations() const {
  std::vector<Location> result(data_->mesh.vertexCount());
  for (int face = 0; face < data_->mesh.faceCount(); ++face) {
    if (data_->refused.count(face)) {
      continue;
    }
    const Span<int> vertices = data_->mesh.faceVertices(face);
    for (int c = 0; c < static_cast<int>(vertices.size()); ++c) {
      Location& location = result[vertices[c]];
      if (location.face >= 0) {
        continue;
      }
      const int first = data_->ptex.first[face];
      if (vertices.size() == 4) {
        location = {first, c == 1 || c == 2 ? 1. : 0., c >= 2 ? 1. : 0.};
      } else {
        location = {first + c, 0, 0};
      }
    }
  }
  return result;
}

}  // namespace limitsurf
