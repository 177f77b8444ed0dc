// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/geodesic_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace limitsurf {
namespace {

constexpr int kSteps = Tessellation::Corner::kSteps;

/// Sets of corners, of which two are united at a time.
class CornerSets {
 public:
  explicit CornerSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int corner) {
    while (parent_[corner] != corner) {
      corner = parent_[corner] = parent_[parent_[corner]];
    }
    return corner;
  }
  void unite(int a, int b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
  }

 private:
  std::vector<int> parent_;
};

/// The edge of the control mesh, as the corner of the base face from which it leaves, on which a
/// side of a polygon lies; -1 for sides inside the face.
int edgeOfSide(const Tessellation::Corner& a, const Tessellation::Corner& b, int size, int corner) {
  if (a.v == 0 && b.v == 0) {
    return size == 4 ? 0 : corner;
  }
  if (a.u == 0 && b.u == 0) {
    return size == 4 ? 3 : (corner + size - 1) % size;
  }
  if (size == 4 && a.u == kSteps && b.u == kSteps) {
    return 1;
  }
  return size == 4 && a.v == kSteps && b.v == kSteps ? 2 : -1;
}

/// How far inside a triangle of the (u, v) square a place lies: the least of its barycentric
/// coordinates.
double depthInside(const std::array<Tessellation::Corner, 3>& corners, double u, double v) {
  const auto area = [](double au, double av, double bu, double bv, double cu, double cv) {
    return (bu - au) * (cv - av) - (cu - au) * (bv - av);
  };
  const auto& [a, b, c] = corners;
  const double whole = area(a.u, a.v, b.u, b.v, c.u, c.v);
  const double of_a = area(u, v, b.u, b.v, c.u, c.v);
  const double of_b = area(a.u, a.v, u, v, c.u, c.v);
  return std::min({of_a, of_b, whole - of_a - of_b}) / whole;
}

}  // namespace

GeodesicMesh::GeodesicMesh(const LimitSurface& surface, const std::vector<int>& levels,
                           const EdgeList& cuts, int threads, const Progress& progress) {
  const std::vector<std::uint8_t> cut_corners = cutCorners(surface.mesh(), cuts);
  TessellationOptions options;
  options.threads = threads;
  options.progress = progress;
  const Tessellation polygons = tessellate(surface, levels, options);
  triangulate(surface, polygons, cut_corners);
  listAround();
  std::vector<int> face_of_triangle;
  face_of_triangle.reserve(triangles_.size());
  for (std::size_t polygon = 0; polygon < polygons.face_sizes.size(); ++polygon) {
    face_of_triangle.insert(face_of_triangle.end(), polygons.face_sizes[polygon] - 2,
                            polygons.ptex_face[polygon]);
  }
  listCells(surface, levels, face_of_triangle);
}

void GeodesicMesh::triangulate(const LimitSurface& surface, const Tessellation& polygons,
                               const std::vector<std::uint8_t>& cut_corners) {
  const ControlMesh& mesh = surface.mesh();
  std::vector<std::uint8_t> is_cut;  // for each side of each triangle
  std::size_t first = 0;
  for (std::size_t polygon = 0; polygon < polygons.face_sizes.size(); ++polygon) {
    const int size = polygons.face_sizes[polygon];
    const int* point = polygons.face_vertices.data() + first;
    const Corner* corner = polygons.corners.data() + first;
    first += static_cast<std::size_t>(size);
    const auto length = [&](int a, int b) {
      return (polygons.positions.row(point[a]) - polygons.positions.row(point[b])).squaredNorm();
    };
    // quads are divided by their shorter diagonal
    const int turn = size == 4 && length(1, 3) < length(0, 2) ? 1 : 0;
    const int face = polygons.base_face[polygon];
    const int ptex_corner = surface.corner()[polygons.ptex_face[polygon]];
    for (int k = 0; k + 2 < size; ++k) {
      const std::array<int, 3> at = {turn, turn + k + 1, (turn + k + 2) % size};
      triangles_.push_back({point[at[0]], point[at[1]], point[at[2]]});
      corners_.push_back({corner[at[0]], corner[at[1]], corner[at[2]]});
      for (int side = 0; side < 3; ++side) {
        const int edge = edgeOfSide(corner[at[side]], corner[at[(side + 1) % 3]],
                                    mesh.faceSize(face), ptex_corner);
        is_cut.push_back(edge >= 0 && cut_corners[mesh.firstCorner(face) + edge]);
      }
    }
  }
  hangTogether(polygons, is_cut);
}

/// Replaces the tessellation's points by vertices: the corners that sides link around a point.
void GeodesicMesh::hangTogether(const Tessellation& polygons,
                                const std::vector<std::uint8_t>& is_cut) {
  struct Side {
    std::uint64_t points;
    int low, high;  // its corners, counted over all triangles, at the smaller and the larger point
  };
  std::vector<Side> sides;
  sides.reserve(is_cut.size());
  for (std::size_t side = 0; side < is_cut.size(); ++side) {
    if (is_cut[side]) {
      continue;
    }
    const std::size_t triangle = side / 3, k = side % 3, next = (k + 1) % 3;
    const int a = triangles_[triangle][k], b = triangles_[triangle][next];
    const int here = static_cast<int>(side), there = static_cast<int>(3 * triangle + next);
    const auto key = [](int low, int high) {
      return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
    };
    sides.push_back(a < b ? Side{key(a, b), here, there} : Side{key(b, a), there, here});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.points != b.points ? a.points < b.points : a.low < b.low;
  });
  CornerSets sets(is_cut.size());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].points == sides[i - 1].points) {
      sets.unite(sides[i].low, sides[i - 1].low);
      sets.unite(sides[i].high, sides[i - 1].high);
    }
  }
  std::vector<int> number(is_cut.size(), -1);
  for (std::size_t corner = 0; corner < is_cut.size(); ++corner) {
    int& vertex = triangles_[corner / 3][corner % 3];
    int& of_set = number[sets.find(static_cast<int>(corner))];
    if (of_set < 0) {
      of_set = static_cast<int>(positions_.size());
      positions_.emplace_back(polygons.positions.row(vertex));
    }
    vertex = of_set;
  }
}

void GeodesicMesh::listAround() {
  first_around_.assign(positions_.size() + 1, 0);
  for (const auto& triangle : triangles_) {
    for (const int vertex : triangle) {
      ++first_around_[vertex + 1];
    }
  }
  std::partial_sum(first_around_.begin(), first_around_.end(), first_around_.begin());
  around_.resize(3 * triangles_.size());
  std::vector<int> end(first_around_.begin(), first_around_.end() - 1);
  for (std::size_t number = 0; number < triangles_.size(); ++number) {
    for (const int vertex : triangles_[number]) {
      around_[end[vertex]++] = static_cast<int>(number);
    }
  }
}

void GeodesicMesh::listCells(const LimitSurface& surface, const std::vector<int>& levels,
                             const std::vector<int>& face_of_triangle) {
  const ControlMesh& mesh = surface.mesh();
  const std::size_t faces = surface.baseFace().size();
  cell_levels_.resize(faces);
  first_cell_.assign(faces + 1, 0);
  for (std::size_t face = 0; face < faces; ++face) {
    const int base = surface.baseFace()[face];
    const int level = levels[base] - (mesh.faceSize(base) == 4 ? 0 : 1);
    // a refused face needs no cells
    cell_levels_[face] = static_cast<std::uint8_t>(surface.refused().count(base) ? 0 : level);
    first_cell_[face + 1] = first_cell_[face] + (std::size_t{1} << 2 * cell_levels_[face]);
  }
  const auto for_each_cell = [&](std::size_t number, const auto& body) {
    const int face = face_of_triangle[number];
    const auto& [a, b, c] = corners_[number];
    const int level = cell_levels_[face], size = kSteps >> level;
    const auto range = [&](int p, int q, int r) {
      return std::pair{std::min({p, q, r}) / size, (std::max({p, q, r}) - 1) / size};
    };
    const auto [u_first, u_last] = range(a.u, b.u, c.u);
    const auto [v_first, v_last] = range(a.v, b.v, c.v);
    for (int v = v_first; v <= v_last; ++v) {
      for (int u = u_first; u <= u_last; ++u) {
        body(first_cell_[face] + (static_cast<std::size_t>(v) << level) + u);
      }
    }
  };
  first_in_cell_.assign(first_cell_.back() + 1, 0);
  for (std::size_t number = 0; number < triangles_.size(); ++number) {
    for_each_cell(number, [&](std::size_t cell) { ++first_in_cell_[cell + 1]; });
  }
  std::partial_sum(first_in_cell_.begin(), first_in_cell_.end(), first_in_cell_.begin());
  in_cell_.resize(first_in_cell_.back());
  std::vector<int> end(first_in_cell_.begin(), first_in_cell_.end() - 1);
  for (std::size_t number = 0; number < triangles_.size(); ++number) {
    for_each_cell(number,
                  [&](std::size_t cell) { in_cell_[end[cell]++] = static_cast<int>(number); });
  }
}

int GeodesicMesh::triangleAt(const Location& at) const {
  const int level = cell_levels_[at.face], side = 1 << level;
  const auto along = [&](double x) { return std::min(static_cast<int>(x * side), side - 1); };
  const std::size_t cell =
      first_cell_[at.face] + (static_cast<std::size_t>(along(at.v)) << level) + along(at.u);
  int best = -1;
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = first_in_cell_[cell]; i < first_in_cell_[cell + 1]; ++i) {
    const double depth = depthInside(corners_[in_cell_[i]], at.u * kSteps, at.v * kSteps);
    if (depth > deepest) {
      deepest = depth;
      best = in_cell_[i];
    }
  }
  return best;
}

}  // namespace limitsurf
