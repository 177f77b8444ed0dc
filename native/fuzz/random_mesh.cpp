// SPDX-License-Identifier: Apache-2.0
#include "fuzz/random_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fuzz/require.h"

namespace limitsurf::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSharpness[] = {
    0,   0.3, 0.5, 1,         1.5, 1.7,       2,  3,
    4.2, 9.9, 10,  kInfinity, 0,   kInfinity, -1, std::numeric_limits<double>::quiet_NaN()};
constexpr int kMostVertices = 60, kMostFaces = 48, kMostEdits = 16;

/// A mesh that is being made.
struct Draft {
  std::vector<Vector3> positions;
  std::vector<std::vector<std::int64_t>> faces;
  MeshOptions options;

  void addGrid(int columns, int rows) {
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x <= columns; ++x) {
        positions.emplace_back(x, y, 0.25 * ((x * 7 + y * 3) % 5));
      }
    }
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const int a = y * (columns + 1) + x, b = a + columns + 1;
        faces.push_back({a, a + 1, b + 1, b});
      }
    }
  }

  /// Faces of any size around a vertex.
  void addFan(int count, int size, bool closed) {
    positions.emplace_back(0, 0, 0.5);
    const int rim = count * (size - 2) + (closed ? 0 : 1);
    for (int i = 0; i < rim; ++i) {
      const double angle = 6 * i / static_cast<double>(rim);
      positions.emplace_back(std::cos(angle), std::sin(angle), 0.1 * (i % 3));
    }
    for (int i = 0; i < count; ++i) {
      std::vector<std::int64_t> face = {0};
      for (int k = 0; k <= size - 2; ++k) {
        face.push_back(1 + (i * (size - 2) + k) % rim);
      }
      faces.push_back(std::move(face));
    }
  }

  void addCube() {
    for (int i = 0; i < 8; ++i) {
      positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
    }
    faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  }

  void addAnything(ByteReader& bytes) {
    const int vertices = 1 + bytes.below(24);
    for (int i = 0; i < vertices; ++i) {
      const double x = bytes.coordinate(), y = bytes.coordinate();
      positions.emplace_back(x, y, bytes.coordinate());
    }
    const int count = bytes.below(16);
    for (int i = 0; i < count; ++i) {
      std::vector<std::int64_t> face(static_cast<std::size_t>(2 + bytes.below(8)));
      for (std::int64_t& vertex : face) {
        vertex = bytes.below(vertices + 1);
        vertex -= bytes.below(64) == 63 ? 1 : 0;
      }
      faces.push_back(std::move(face));
    }
  }

  std::int64_t vertex(ByteReader& bytes) const {
    return bytes.below(static_cast<int>(positions.size()));
  }
  std::vector<std::int64_t>& face(ByteReader& bytes) {
    return faces[static_cast<std::size_t>(bytes.below(static_cast<int>(faces.size())))];
  }

  void edit(ByteReader& bytes) {
    if (positions.empty() || faces.empty()) {
      return;
    }
    switch (bytes.below(12)) {
      case 0: {  // two vertices become one
        const std::int64_t from = vertex(bytes), to = vertex(bytes);
        for (auto& one : faces) {
          std::replace(one.begin(), one.end(), from, to);
        }
        break;
      }
      case 1:
        face(bytes) = faces.back();
        faces.pop_back();
        break;
      case 2: {
        auto& one = face(bytes);
        std::reverse(one.begin(), one.end());
        break;
      }
      case 3:
        if (faces.size() < kMostFaces) {
          faces.push_back(std::vector<std::int64_t>(face(bytes)));
        }
        break;
      case 4: {
        Vector3& position = positions[static_cast<std::size_t>(vertex(bytes))];
        position[bytes.below(3)] = bytes.coordinate();
        break;
      }
      case 5:
      case 6: {
        const auto& one = face(bytes);
        if (!one.empty()) {
          const std::size_t corner = static_cast<std::size_t>(bytes.byte()) % one.size();
          options.edge_sharpness.edges.emplace_back(one[corner], one[(corner + 1) % one.size()]);
          options.edge_sharpness.values.push_back(kSharpness[bytes.below(16)]);
        }
        break;
      }
      case 7:
        options.vertex_sharpness.vertices.push_back(vertex(bytes));
        options.vertex_sharpness.values.push_back(kSharpness[bytes.below(16)]);
        break;
      case 8:
        options.holes.push_back(bytes.below(static_cast<int>(faces.size()) + 1));
        break;
      case 9: {  // a corner less
        auto& one = face(bytes);
        if (one.size() > 3) {
          one.erase(one.begin() + bytes.below(static_cast<int>(one.size())));
        }
        break;
      }
      case 10: {  // a copy somewhere else, with a vertex in common
        const std::size_t count = positions.size();
        if (2 * count > kMostVertices || 2 * faces.size() > kMostFaces) {
          break;
        }
        for (std::size_t i = 0; i < count; ++i) {
          positions.push_back(positions[i] + Vector3(0, 0, 1));
        }
        const std::size_t old = faces.size();
        for (std::size_t i = 0; i < old; ++i) {
          faces.push_back(faces[i]);
          for (std::int64_t& one : faces.back()) {
            one = one == 0 ? 0 : one + static_cast<std::int64_t>(count);
          }
        }
        break;
      }
      default:
        transform(bytes);
    }
  }

  /// Makes the mesh huge or tiny, flat or far away.
  void transform(ByteReader& bytes) {
    const int axis = bytes.below(3);
    double factor = 1, offset = 0;
    bool all = false;
    switch (bytes.below(6)) {
      case 0:
        factor = 0;
        break;
      case 1:
        factor = 1e-9;
        break;
      case 2:
        factor = 1e7;
        break;
      case 3:
        offset = 1e9;
        break;
      default:
        all = true;
        factor = std::ldexp(1., 4 * (bytes.byte() - 128));
    }
    for (Vector3& position : positions) {
      for (int i = 0; i < 3; ++i) {
        if (all || i == axis) {
          position[i] = factor * position[i] + offset;
        }
      }
    }
  }
};

}  // namespace

std::unique_ptr<LimitSurface> readSurface(ByteReader& bytes) {
  Draft draft;
  const int options = bytes.byte();
  draft.options.boundary = (options & 1) != 0 ? Boundary::corners : Boundary::smooth;
  draft.options.creasing = (options & 2) != 0 ? Creasing::chaikin : Creasing::uniform;
  draft.options.triangles = (options & 4) != 0 ? Triangles::smooth : Triangles::catmark;
  draft.options.scheme = (options & 8) != 0 ? Scheme::bilinear : Scheme::catmark;
  switch (bytes.below(5)) {
    case 0: {
      const int columns = 1 + bytes.below(5);
      draft.addGrid(columns, 1 + bytes.below(4));
      break;
    }
    case 1: {
      const int count = 1 + bytes.below(10), size = 3 + bytes.below(3);
      draft.addFan(count, size, bytes.flag());
      break;
    }
    case 2:
      draft.addCube();
      break;
    default:
      draft.addAnything(bytes);
  }
  for (int i = bytes.below(kMostEdits); i > 0; --i) {
    draft.edit(bytes);
  }
  Points positions(static_cast<Eigen::Index>(draft.positions.size()), 3);
  for (Eigen::Index row = 0; row < positions.rows(); ++row) {
    positions.row(row) = draft.positions[static_cast<std::size_t>(row)].transpose();
  }
  std::vector<std::int64_t> sizes, vertices;
  for (const auto& face : draft.faces) {
    sizes.push_back(static_cast<std::int64_t>(face.size()));
    vertices.insert(vertices.end(), face.begin(), face.end());
  }
  std::unique_ptr<LimitSurface> surface;
  accepts([&] {
    surface = std::make_unique<LimitSurface>(
        ControlMesh(std::move(positions), sizes, vertices, std::move(draft.options)));
  });
  return surface;
}

std::vector<Location> readLocations(ByteReader& bytes, const LimitSurface& surface, int count) {
  std::vector<int> faces;
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[static_cast<std::size_t>(face)]) == 0) {
      faces.push_back(face);
    }
  }
  std::vector<Location> at;
  for (int i = 0; i < count && !faces.empty(); ++i) {
    Location location;
    location.face = faces[static_cast<std::size_t>(bytes.byte()) % faces.size()];
    location.u = bytes.parameter();
    location.v = bytes.parameter();
    if (location.u >= 0 && location.u <= 1 && location.v >= 0 && location.v <= 1) {
      at.push_back(location);
    } else {
      require(!accepts([&] { surface.evaluate({&location, 1}); }),
              "a location out of range is refused");
    }
  }
  return at;
}

double diagonalOf(const LimitSurface& surface) {
  const Points& points = surface.positions();
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).stableNorm();
}

}  // namespace limitsurf::fuzz
