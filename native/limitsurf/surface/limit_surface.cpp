// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/limit_surface.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "limitsurf/surface/curvature/irregular_curvature.h"
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

void checkCurvatureRadius(double radius) {
  if (!(radius > 0 && radius <= 0.5)) {
    std::ostringstream message;
    message << "radius is " << radius << "; expected more than 0 and at most 0.5";
    throw std::invalid_argument(message.str());
  }
}

Curvature LimitSurface::curvature(const LocationBatch& at, IrregularRule rule, double radius,
                                  int threads) const {
  data_->check(at, threads);
  checkCurvatureRadius(radius);
  const auto rows = static_cast<Eigen::Index>(at.size());
  Curvature out;
  for (Eigen::VectorXd* values : {&out.gaussian, &out.mean, &out.k1, &out.k2}) {
    values->resize(rows);
  }
  out.direction1.resize(rows, 3);
  out.direction2.resize(rows, 3);
  out.irregular.resize(rows);
  const auto put = [&](Eigen::Index row, const PrincipalCurvatures& k) {
    out.k1[row] = k.k1;
    out.k2[row] = k.k2;
    out.mean[row] = k.k1 / 2 + k.k2 / 2;
    out.gaussian[row] = k.k1 * k.k2;
    out.direction1.row(row) = k.direction1;
    out.direction2.row(row) = k.direction2;
  };
  std::vector<int> rings(at.size());  // at irregular rows: the vertex's ring
  data_->forEach(at, threads,
                 [&](Eigen::Index row, const TileLocation& place, TileEvaluator& evaluator) {
                   Jet jet;
                   evaluator.evaluate<2>(place, jet);
                   put(row, principalCurvatures(evaluator.fundamentalForms(place, jet)));
                   out.irregular[row] = place.atVertex();
                   if (place.atVertex()) {
                     rings[row] = data_->table.ring_tiles[place.tile.index].ring;
                   }
                 });
  if (rule == IrregularRule::none || !out.irregular.any()) {
    return out;
  }
  std::vector<int> wanted;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (out.irregular[row]) {
      wanted.push_back(rings[row]);
    }
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const IrregularCurvature irregular(data_->table, data_->pose, data_->ptex, radius);
  const std::vector<PrincipalCurvatures> means = irregular.around(wanted, threads);
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (out.irregular[row]) {
      put(row, means[std::lower_bound(wanted.begin(), wanted.end(), rings[row]) - wanted.begin()]);
    }
  }
  return out;
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
