// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/tessellation_numbers.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kFacesPerTask = 16, kCornersPerTask = 1 << 16;

}  // namespace

TessellationNumbers::TessellationNumbers(const ControlMesh& mesh, const PtexFaces& ptex,
                                         const std::map<int, std::string>& refused,
                                         const std::vector<int>& levels, int threads)
    : mesh_(mesh), ptex_(ptex), levels_(levels), edges_(mesh) {
  for (int face = 0; face < mesh.faceCount(); ++face) {
    if (!refused.count(face)) {
      faces_.push_back(face);
    }
  }
  levelEdges();
  findOwners();
  count(threads);
}

void TessellationNumbers::levelEdges() {
  edge_level_.assign(edges_.count, 0);
  for (const int face : faces_) {
    for (int k = 0; k < mesh_.faceSize(face); ++k) {
      int& level = edge_level_[edges_.of_corner[mesh_.firstCorner(face) + k]];
      level = std::max(level, levels_[face]);
    }
  }
  first_slot_.resize(edges_.count);
  slot_count_ = static_cast<std::size_t>(mesh_.vertexCount());
  for (int edge = 0; edge < edges_.count; ++edge) {
    first_slot_[edge] = slot_count_;
    slot_count_ += pointsInside(edge);
  }
}

void TessellationNumbers::findOwners() {
  vertex_owner_.assign(mesh_.vertexCount(), -1);
  edge_owner_.assign(edges_.count, -1);
  for (const int face : faces_) {
    const Span<int> vertices = mesh_.faceVertices(face);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      int& of_vertex = vertex_owner_[vertices[k]];
      int& of_edge = edge_owner_[edges_.of_corner[mesh_.firstCorner(face) + k]];
      of_vertex = of_vertex < 0 ? face : of_vertex;
      of_edge = of_edge < 0 ? face : of_edge;
    }
  }
}

void TessellationNumbers::count(int threads) {
  first_point_.assign(faces_.size() + 1, 0);
  first_polygon_ = first_corner_ = first_point_;
  parallelFor(faces_.size(), kFacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    Divided divided;
    for (std::size_t i = begin; i < end; ++i) {
      const int face = faces_[i];
      divide(face, divided);
      countInside(divided.division, i + 1);
      for (int k = 0; k < mesh_.faceSize(face); ++k) {
        const int corner = mesh_.firstCorner(face) + k, edge = edges_.of_corner[corner];
        first_point_[i + 1] += vertex_owner_[mesh_.faceVertices()[corner]] == face;
        first_point_[i + 1] += edge_owner_[edge] == face ? pointsInside(edge) : 0;
      }
    }
  });
  for (std::vector<std::size_t>* counts : {&first_point_, &first_polygon_, &first_corner_}) {
    std::partial_sum(counts->begin(), counts->end(), counts->begin());
  }
}

void TessellationNumbers::countInside(const FaceDivision& division, std::size_t i) {
  if (!division.isUniform()) {
    const GradedFace graded(division);
    first_point_[i] = graded.insidePointCount();
    first_polygon_[i] = graded.polygonCount();
    first_corner_[i] = graded.cornerCount();
    return;
  }
  const std::size_t n = std::size_t{1} << division.squareLevel();
  const std::size_t squares = static_cast<std::size_t>(division.squareCount());
  first_point_[i] = division.isQuad() ? (n - 1) * (n - 1) : squares * n * (n - 1) + 1;
  first_polygon_[i] = squares * n * n;
  first_corner_[i] = 4 * squares * n * n;
}

void TessellationNumbers::divide(int face, Divided& divided) const {
  const int size = mesh_.faceSize(face), first = mesh_.firstCorner(face);
  divided.edge_levels.resize(size);
  for (int k = 0; k < size; ++k) {
    divided.edge_levels[k] = edge_level_[edges_.of_corner[first + k]];
  }
  divided.division = {size, levels_[face], divided.edge_levels};
}

void TessellationNumbers::fill(Tessellation& result, int threads) const {
  resizeInParts(result.locations, pointCount());
  for (std::vector<int>* values : {&result.face_sizes, &result.base_face, &result.ptex_face}) {
    resizeInParts(*values, first_polygon_.back());
  }
  resizeInParts(result.face_vertices, first_corner_.back());
  resizeInParts(result.corners, first_corner_.back());
  std::vector<int> number_of_slot(slot_count_, -1);
  parallelFor(faces_.size(), kFacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      fillFace(i, number_of_slot, result);
    }
  });
  parallelFor(result.face_vertices.size(), kCornersPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  int& vertex = result.face_vertices[i];
                  vertex = vertex < 0 ? number_of_slot[~vertex] : vertex;
                }
              });
}

void TessellationNumbers::fillFace(std::size_t i, std::vector<int>& number_of_slot,
                                   Tessellation& result) const {
  const int face = faces_[i], ptex_face = ptex_.first[face];
  Divided divided;
  divide(face, divided);
  const FaceDivision& division = divided.division;
  InsideNumbers inside(division);
  std::size_t point = first_point_[i], polygon = first_polygon_[i], corner = first_corner_[i];

  const auto numbered = [&](int& number, const GridPoint& at) {
    if (number < 0) {
      number = static_cast<int>(point);
      result.locations[point++] = {ptex_face + at.square, static_cast<double>(at.i) / kGridSide,
                                   static_cast<double>(at.j) / kGridSide};
    }
    return number;
  };
  const auto numberOf = [&](const GridPoint& at) {
    const FacePlace place = division.place(at);
    if (place.kind == FacePlace::kInside) {
      return numbered(inside[place.inside], at);
    }
    const auto [slot, is_mine] = slotOf(face, place);
    return is_mine ? numbered(number_of_slot[slot], at) : ~static_cast<int>(slot);
  };
  const auto add = [&](Span<GridPoint> corners) {
    result.face_sizes[polygon] = static_cast<int>(corners.size());
    result.base_face[polygon] = face;
    result.ptex_face[polygon++] = ptex_face + corners[0].square;
    for (const GridPoint& at : corners) {
      result.corners[corner] = {static_cast<std::uint16_t>(at.i), static_cast<std::uint16_t>(at.j)};
      result.face_vertices[corner++] = numberOf(at);
    }
  };
  if (division.isUniform()) {
    forEachQuad(division, add);
  } else {
    GradedFace(division).forEachPolygon(add);
  }
}

std::pair<std::size_t, bool> TessellationNumbers::slotOf(int face, const FacePlace& place) const {
  const Span<int> vertices = mesh_.faceVertices(face);
  const int from = vertices[place.element];
  if (place.kind == FacePlace::kVertex) {
    return {static_cast<std::size_t>(from), vertex_owner_[from] == face};
  }
  const int to = vertices[(place.element + 1) % mesh_.faceSize(face)];
  const int edge = edges_.of_corner[mesh_.firstCorner(face) + place.element];
  const int step = (from < to ? place.step : 2 * kGridSide - place.step) >>
                   (kMostTessellationLevels + 1 - edge_level_[edge]);
  return {first_slot_[edge] + static_cast<std::size_t>(step) - 1, edge_owner_[edge] == face};
}

}  // namespace limitsurf
