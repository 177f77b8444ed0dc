// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/surface_data.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "limitsurf/large_pages.h"
#include "limitsurf/mesh/face_varying_mesh.h"
#include "limitsurf/mesh/limits.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/batch/batch_evaluation.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/surface_data_poses.h"

namespace limitsurf {
namespace {

/// The number of rows of which three columns are evaluated at a time.
constexpr std::size_t kRowsPerPart = std::size_t{1} << 15;

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
  checkThreads(threads);
  const std::size_t rows = at.size();
  DataEvaluation out;
  std::vector<DataRows*> wanted{&out.value};
  if (derivatives >= Derivatives::first) {
    wanted.insert(wanted.end(), {&out.du, &out.dv});
  }
  if (derivatives == Derivatives::second) {
    wanted.insert(wanted.end(), {&out.duu, &out.duv, &out.dvv});
  }
  for (DataRows* const values : wanted) {
    values->resize(0, data_->columns);
    resizeRows(*values, rows);
  }
  if (data_->columns == Data::kColumnsPerPose) {
    const PatchResults<double> results{out.value.data(), out.du.data(),  out.dv.data(),
                                       out.duu.data(),   out.duv.data(), out.dvv.data(),
                                       nullptr};
    evaluateBatch(*data_->tiles, data_->poses[0], at, derivatives, results, threads);
    return out;
  }
  data_->tiles->check(at, threads);  // parts of a batch would not say which of its rows is wrong
  Points part[6];
  for (std::size_t begin = 0; begin < rows; begin += kRowsPerPart) {
    const std::size_t count = std::min(kRowsPerPart, rows - begin);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      part[i].resize(static_cast<Eigen::Index>(count), 3);
    }
    const PatchResults<double> results{part[0].data(), part[1].data(), part[2].data(),
                                       part[3].data(), part[4].data(), part[5].data(),
                                       nullptr};
    Eigen::Index first = 0;
    for (const Pose& pose : data_->poses) {
      evaluateBatch(*data_->tiles, pose, at.rows(begin, count), derivatives, results, threads);
      const Eigen::Index columns = std::min(Data::kColumnsPerPose, data_->columns - first);
      parallelFor(count, kRowsPerTask, threads, [&](std::size_t low, std::size_t high) {
        const auto row = static_cast<Eigen::Index>(low),
                   some = static_cast<Eigen::Index>(high - low);
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          wanted[i]->block(static_cast<Eigen::Index>(begin) + row, first, some, columns) =
              part[i].block(row, 0, some, columns);
        }
      });
      first += columns;
    }
  }
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
