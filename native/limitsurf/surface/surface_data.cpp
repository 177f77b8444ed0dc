// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/surface_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "limitsurf/batch_parts.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/mesh/face_varying_mesh.h"
#include "limitsurf/mesh/limits.h"
#include "limitsurf/number_text.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/batch/batch_evaluation.h"
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

/// Copies the first `count` numbers of each row of three.
template <typename Real>
void putColumns(const Real* from, std::size_t rows, std::size_t count, Real* to,
                std::size_t columns) {
  for (std::size_t row = 0; row < rows; ++row, from += 3, to += columns) {
    to[0] = from[0];
    if (count > 1) {
      to[1] = from[1];
    }
    if (count > 2) {
      to[2] = from[2];
    }
  }
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

LocationBatch SurfaceData::checkLocations(const LocationBatch& at, int threads) const {
  checkThreads(threads);
  return data_->tiles->checked(at, threads);
}

DataEvaluation SurfaceData::evaluate(const LocationBatch& at, Derivatives derivatives,
                                     int threads) const {
  checkThreads(threads);
  DataEvaluation out;
  const auto rows = [&](DataRows& values, Derivatives least) -> DataArrays<double>::Rows {
    if (derivatives < least) {
      return {};
    }
    values.resize(0, data_->columns);
    resizeRows(values, at.size());
    return {values.data(), at.size()};
  };
  evaluate<double>(at, derivatives,
                   {rows(out.value, Derivatives::none), rows(out.du, Derivatives::first),
                    rows(out.dv, Derivatives::first), rows(out.duu, Derivatives::second),
                    rows(out.duv, Derivatives::second), rows(out.dvv, Derivatives::second)},
                   threads);
  return out;
}

template <typename Real>
void SurfaceData::evaluate(const LocationBatch& at, Derivatives derivatives,
                           const DataArrays<Real>& results, int threads) const {
  checkThreads(threads);
  const auto of = [&](const char* name, const typename DataArrays<Real>::Rows& array,
                      Derivatives least) -> Real* {
    if (derivatives < least) {
      return nullptr;
    }
    checkRows(name, static_cast<Eigen::Index>(array.count), static_cast<Eigen::Index>(at.size()));
    return array.numbers;
  };
  const std::array<Real*, 6> into = {
      of("value", results.value, Derivatives::none), of("du", results.du, Derivatives::first),
      of("dv", results.dv, Derivatives::first),      of("duu", results.duu, Derivatives::second),
      of("duv", results.duv, Derivatives::second),   of("dvv", results.dvv, Derivatives::second)};
  if (data_->columns == Data::kColumnsPerPose) {
    evaluateBatch<Real>(*data_->tiles, data_->poses[0], at, derivatives,
                        {into[0], into[1], into[2], into[3], into[4], into[5], nullptr}, threads);
    return;
  }
  // Parts of a batch would not say which of its rows is wrong.
  const LocationBatch checked = data_->tiles->checked(at, threads);
  using Part = std::array<std::vector<Real>, 6>;  // three columns of all results
  const auto part = [&](std::size_t rows) {
    Part numbers;
    for (std::size_t i = 0; i < into.size(); ++i) {
      numbers[i].resize(into[i] ? 3 * rows : 0);
    }
    return numbers;
  };
  const auto columns = static_cast<std::size_t>(data_->columns);
  forEachPart(at.size(), threads, part, [&](std::size_t begin, std::size_t end, Part& of_pose) {
    std::array<Real*, 6> to{};
    for (std::size_t i = 0; i < into.size(); ++i) {
      to[i] = into[i] ? of_pose[i].data() : nullptr;
    }
    // Other threads of the caller may change the locations; all columns shall be of the same ones.
    std::vector<Location> same(data_->poses.size() > 1 ? end - begin : 0);
    for (std::size_t i = 0; i < same.size(); ++i) {
      same[i] = checked[begin + i];
    }
    const LocationBatch rows = same.empty() ? checked.rows(begin, end - begin) : same;
    std::size_t first = 0;
    for (const Pose& pose : data_->poses) {
      evaluateBatch<Real>(*data_->tiles, pose, rows, derivatives,
                          {to[0], to[1], to[2], to[3], to[4], to[5], nullptr}, 1);
      const std::size_t count = std::min<std::size_t>(Data::kColumnsPerPose, columns - first);
      for (std::size_t i = 0; i < into.size(); ++i) {
        if (into[i]) {
          putColumns(to[i], end - begin, count, into[i] + columns * begin + first, columns);
        }
      }
      first += count;
    }
  });
}

template void SurfaceData::evaluate(const LocationBatch&, Derivatives, const DataArrays<double>&,
                                    int) const;
template void SurfaceData::evaluate(const LocationBatch&, Derivatives, const DataArrays<float>&,
                                    int) const;

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
