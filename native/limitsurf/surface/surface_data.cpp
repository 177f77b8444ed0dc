// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/surface_data.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "limitsurf/mesh/face_varying_mesh.h"
#include "limitsurf/mesh/limits.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/surface_data_poses.h"

namespace limitsurf {
namespace {

void checkValues(const DataRows& values) {
  if (values.cols() < 1) {
    throw MeshError("values has no columns");
  }
  if (values.rows() > kMaxCorners) {
    throw MeshError("values has " + std::to_string(values.rows()) + " rows; the limit is " +
                    std::to_string(kMaxCorners));
  }
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      const double value = values(row, column);
      if (!(std::abs(value) <= kLargestCoordinate)) {  // NaN included
        std::ostringstream message;
        message << "row " << row << " of values has " << numberText(value) << " in column "
                << column << "; values must be finite, and at most " << kLargestCoordinate;
        throw MeshError(message.str());
      }
    }
  }
}

void checkVertexValues(const DataRows& values, const ControlMesh& mesh) {
  if (values.rows() != mesh.vertexCount()) {
    throw MeshError("values has " + std::to_string(values.rows()) + " rows; the mesh has " +
                    std::to_string(mesh.vertexCount()) + " vertices");
  }
  checkValues(values);
}

/// The same faces under the bilinear scheme.
ControlMesh bilinearMesh(const ControlMesh& mesh, const std::map<int, std::string>& refused) {
  const std::vector<int> sizes = mesh.faceSizes();
  const std::vector<int>& vertices = mesh.faceVertices();
  MeshOptions options;
  options.scheme = Scheme::bilinear;
  for (const auto& [face, reason] : refused) {
    options.holes.push_back(face);
  }
  return ControlMesh(Points::Zero(mesh.vertexCount(), 3), {sizes.begin(), sizes.end()},
                     {vertices.begin(), vertices.end()}, std::move(options));
}

/// The tiles of a mesh that has the same faces as the surface's and refuses those in `refused` as
/// well.
std::shared_ptr<const TiledSurface> tilesOf(const ControlMesh& mesh,
                                            std::map<int, std::string> refused,
                                            SeamSharpness seams = {}) {
  auto tiles = std::make_shared<TiledSurface>(mesh, Topology(mesh, std::move(seams)));
  refused.merge(tiles->refused);
  tiles->refused = std::move(refused);
  return tiles;
}

}  // namespace

SurfaceData::Data::Data(std::shared_ptr<const TiledSurface> surface, std::vector<int> vertex_rows,
                        const DataRows& values, int threads)
    : tiles(std::move(surface)),
      rows_of_vertices(std::move(vertex_rows)),
      rows(values.rows()),
      columns(values.cols()) {
  for (Eigen::Index column = 0; column < columns; column += kColumnsPerPose) {
    poses.emplace_back(tiles->table);
  }
  set(values, threads);
}

void SurfaceData::Data::set(const DataRows& values, int threads) {
  is_set = false;  // while some poses are those of other values
  const Eigen::Index vertices =
      rows_of_vertices.empty() ? values.rows() : static_cast<Eigen::Index>(rows_of_vertices.size());
  Points points = Points::Zero(vertices, 3);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * kColumnsPerPose;
    const Eigen::Index count = std::min(kColumnsPerPose, columns - first);
    points.rightCols(3 - count).setZero();
    InterruptionStride stride;
    for (Eigen::Index vertex = 0; vertex < vertices; ++vertex) {
      stride.step();
      const Eigen::Index row =
          rows_of_vertices.empty() ? vertex : rows_of_vertices[static_cast<std::size_t>(vertex)];
      points.row(vertex).head(count) = values.row(row).segment(first, count);
    }
    poses[i].set(points, threads);
  }
  is_set = true;
}

SurfaceData::SurfaceData(std::unique_ptr<Data> data) : data_(std::move(data)) {}
SurfaceData::~SurfaceData() = default;
SurfaceData::SurfaceData(SurfaceData&&) noexcept = default;
SurfaceData& SurfaceData::operator=(SurfaceData&&) noexcept = default;

int SurfaceData::faceCount() const { return static_cast<int>(data_->tiles->table.faces.size()); }
Eigen::Index SurfaceData::rows() const { return data_->rows; }
Eigen::Index SurfaceData::columns() const { return data_->columns; }

void SurfaceData::setValues(const DataRows& values, int threads) {
  checkThreads(threads);
  if (values.rows() != rows() || values.cols() != columns()) {
    std::ostringstream message;
    message << "values has shape (" << values.rows() << ", " << values.cols() << "); expected ("
            << rows() << ", " << columns() << ")";
    throw MeshError(message.str());
  }
  checkValues(values);
  data_->set(values, threads);
}

bool SurfaceData::isSet() const { return data_->is_set; }

LocationBatch SurfaceData::checkLocations(const LocationBatch& at) const {
  return data_->tiles->checked(at);
}

DataEvaluation SurfaceData::evaluate(const LocationBatch& at, Derivatives derivatives,
                                     int threads) const {
  data_->tiles->check(at, threads);
  const auto rows = static_cast<Eigen::Index>(at.size());
  const Eigen::Index columns = data_->columns;
  DataEvaluation out;
  out.value.resize(rows, columns);
  if (derivatives >= Derivatives::first) {
    out.du.resize(rows, columns);
    out.dv.resize(rows, columns);
  }
  if (derivatives == Derivatives::second) {
    out.duu.resize(rows, columns);
    out.duv.resize(rows, columns);
    out.dvv.resize(rows, columns);
  }

  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    Eigen::Index first = 0, row = 0;
    const auto put = [&](DataRows& to, const Padded& values) {
      const Eigen::Index count = std::min(Data::kColumnsPerPose, columns - first);
      to.row(row).segment(first, count) = values.head(count).matrix().transpose();
    };
    for (const Pose& pose : data_->poses) {
      TileEvaluator evaluator(data_->tiles->table, pose);
      for (std::size_t i = begin; i < end; ++i) {
        row = static_cast<Eigen::Index>(i);
        Jet jet;
        evaluator.evaluateUpTo(static_cast<int>(derivatives), evaluator.locate(at[i]), jet);
        put(out.value, jet.anchor + jet.patch.value);
        if (derivatives >= Derivatives::first) {
          put(out.du, jet.patch.du);
          put(out.dv, jet.patch.dv);
        }
        if (derivatives == Derivatives::second) {
          put(out.duu, jet.second(jet.patch.duu));
          put(out.duv, jet.second(jet.patch.duv));
          put(out.dvv, jet.second(jet.patch.dvv));
        }
      }
      first += Data::kColumnsPerPose;
    }
  });
  return out;
}

SurfaceData LimitSurface::faceVarying(const DataRows& values,
                                      const std::vector<std::int64_t>& indices,
                                      Interpolation interpolation, int threads) const {
  checkThreads(threads);
  checkValues(values);
  FaceVaryingMesh channel =
      faceVaryingMesh(data_->mesh, Topology(data_->mesh), indices, values.rows(), interpolation);
  return SurfaceData(std::make_unique<SurfaceData::Data>(
      tilesOf(channel.mesh, data_->refused, std::move(channel.seams)), std::move(channel.values),
      values, threads));
}

SurfaceData LimitSurface::vertexData(const DataRows& values, int threads) const {
  checkThreads(threads);
  checkVertexValues(values, data_->mesh);
  return SurfaceData(
      std::make_unique<SurfaceData::Data>(data_->tiles, std::vector<int>{}, values, threads));
}

SurfaceData LimitSurface::varying(const DataRows& values, int threads) const {
  checkThreads(threads);
  checkVertexValues(values, data_->mesh);
  return SurfaceData(std::make_unique<SurfaceData::Data>(
      tilesOf(bilinearMesh(data_->mesh, data_->refused), data_->refused), std::vector<int>{},
      values, threads));
}

}  // namespace limitsurf
