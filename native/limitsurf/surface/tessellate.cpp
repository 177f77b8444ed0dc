// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

constexpr int kMostLevels = 12;

/// Hands out the tessellation's points: one for each vertex of the mesh, for each step along an
/// edge and for each place inside a face, made when a face first asks for it.
class PointNumbers {
 public:
  PointNumbers(const ControlMesh& mesh, const PtexFaces& ptex, int side)
      : mesh_(mesh), ptex_(ptex), side_(side), vertices_(mesh.vertexCount(), -1) {}

  const std::vector<Location>& locations() const { return locations_; }

  void startFace(int face) {
    face_ = face;
    vertices_of_face_ = mesh_.faceVertices(face);
    inside_.clear();
  }

  /// A quad's point (i, j), 0 <= i, j <= side.
  int quadPoint(int i, int j) {
    const Location at = location(ptex_.first[face_], i, j, side_);
    const int n = side_;
    if (j == 0) {
      return onEdge(0, i, at);
    }
    if (i == n) {
      return onEdge(1, j, at);
    }
    if (j == n) {
      return onEdge(2, n - i, at);
    }
    if (i == 0) {
      return onEdge(3, n - j, at);
    }
    return inside(0, i, j, at);
  }

  /// An n-gon's point (i, j) of its sub-face at a corner, 0 <= i, j <= side / 2.
  int subFacePoint(int corner, int i, int j) {
    const int half = side_ / 2, size = static_cast<int>(vertices_of_face_.size());
    const Location at = location(ptex_.first[face_] + corner, i, j, half);
    const int before = (corner + size - 1) % size;
    if (j == 0) {
      return onEdge(corner, i, at);
    }
    if (i == 0) {
      return onEdge(before, side_ - j, at);
    }
    if (i == half && j == half) {
      return inside(0, half, half, at);  // the centre
    }
    if (j == half) {
      return inside(before, half, i, at);  // on the line from an edge's middle to the centre
    }
    return inside(corner, i, j, at);
  }

 private:
  static Location location(int face, int i, int j, int n) {
    return {face, static_cast<double>(i) / n, static_cast<double>(j) / n};
  }

  int make(const Location& at) {
    locations_.push_back(at);
    return static_cast<int>(locations_.size()) - 1;
  }

  int onEdge(int edge, int step, const Location& at) {
    const int size = static_cast<int>(vertices_of_face_.size());
    int from = vertices_of_face_[edge], to = vertices_of_face_[(edge + 1) % size];
    if (step == 0 || step == side_) {
      int& point = vertices_[step == 0 ? from : to];
      return point >= 0 ? point : point = make(at);
    }
    if (from > to) {
      std::swap(from, to);
      step = side_ - step;
    }
    const std::uint64_t key =
        (static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint32_t>(to));
    std::vector<int>& points = edges_[key];
    points.resize(static_cast<std::size_t>(side_), -1);
    int& point = points[step];
    return point >= 0 ? point : point = make(at);
  }

  int inside(int corner, int i, int j, const Location& at) {
    const std::size_t place =
        (static_cast<std::size_t>(corner) * (side_ + 1) + i) * (side_ + 1) + j;
    if (inside_.size() <= place) {
      inside_.resize(place + 1, -1);
    }
    int& point = inside_[place];
    return point >= 0 ? point : point = make(at);
  }

  const ControlMesh& mesh_;
  const PtexFaces& ptex_;
  const int side_;
  int face_ = 0;
  Span<int> vertices_of_face_;
  std::vector<int> vertices_, inside_;
  std::unordered_map<std::uint64_t, std::vector<int>> edges_;
  std::vector<Location> locations_;
};

}  // namespace

Tessellation LimitSurface::tessellate(int levels, int threads) const {
  data_->check({}, threads);
  const ControlMesh& mesh = data_->mesh;
  const bool only_quads = faceCount() == mesh.faceCount();
  if (levels < (only_quads ? 0 : 1) || levels > kMostLevels) {
    throw std::invalid_argument("levels is " + std::to_string(levels) + "; expected " +
                                (only_quads ? "0" : "1") + " to " + std::to_string(kMostLevels));
  }
  const int side = 1 << levels;
  const std::size_t most_points =
      (mesh.faceVertices().size() / 3 + 1) * (side + std::size_t{1}) * (side + std::size_t{1});
  if (most_points > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw std::invalid_argument("levels is " + std::to_string(levels) + " on " +
                                std::to_string(mesh.faceCount()) + " faces: up to " +
                                std::to_string(most_points) + " points are too many");
  }
  PointNumbers numbers(mesh, data_->ptex, side);
  Tessellation result;
  const auto addQuads = [&](int n, const auto& point) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          result.face_vertices.push_back(point(i + di, j + dj));
        }
      }
    }
  };
  for (int face = 0; face < mesh.faceCount(); ++face) {
    if (data_->refused.count(face)) {
      continue;
    }
    InterruptionPoint::pass();
    numbers.startFace(face);
    if (mesh.faceSize(face) == 4) {
      addQuads(side, [&](int i, int j) { return numbers.quadPoint(i, j); });
      continue;
    }
    for (int corner = 0; corner < mesh.faceSize(face); ++corner) {
      addQuads(side / 2, [&](int i, int j) { return numbers.subFacePoint(corner, i, j); });
    }
  }
  result.locations = numbers.locations();
  Evaluation points = evaluate(result.locations, Derivatives::first, true, threads);
  result.positions = std::move(points.position);
  result.normals = std::move(points.normal);
  std::vector<Location> without;  // at irregular vertices any sector's own direction has to do
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < result.normals.rows(); ++row) {
    if (!result.normals.row(row).allFinite()) {
      without.push_back(result.locations[static_cast<std::size_t>(row)]);
      rows.push_back(row);
    }
  }
  const auto rotations = frames(without, threads);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto rotation = rotations.row(static_cast<Eigen::Index>(i));
    result.normals.row(rows[i]) << rotation[2], rotation[5], rotation[8];
  }
  return result;
}

}  // namespace limitsurf
