// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/tessellation.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/large_pages.h"
#include "limitsurf/mesh/ptex_faces.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/batch/part_evaluator.h"
#include "limitsurf/surface/complete_normals.h"
#include "limitsurf/tessellate/tessellation_numbers.h"

namespace limitsurf {
namespace {

/// The part of the progress that all but the normals of corners has.
constexpr double kPointsPart = 0.8;

static_assert(Tessellation::Corner::kSteps == kGridSide);

std::string allowedLevels(int least) {
  return "; expected " + std::to_string(least) + " to " + std::to_string(kMostTessellationLevels);
}

/// Throws std::invalid_argument where points could not be counted with an int.
void checkSize(std::size_t points, const std::string& whose) {
  if (points > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw std::invalid_argument(whose + ": " + std::to_string(points) +
                                " points or more are too many");
  }
}

/// The number of points inside faces if no edge is finer than its face: there are at least as many.
std::size_t leastPoints(const ControlMesh& mesh, const std::vector<int>& levels) {
  std::size_t points = 0;
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const bool is_quad = mesh.faceSize(face) == 4;
    const std::size_t side = (std::size_t{1} << (is_quad ? levels[face] : levels[face] - 1)) - 1;
    points += side * side * (is_quad ? 1 : static_cast<std::size_t>(mesh.faceSize(face)));
  }
  return points;
}

/// Evaluates positions and normals, which are completed, of some locations.
void evaluatePart(const LimitSurface& surface, PartEvaluator& evaluate, Span<Location> part,
                  double* position, double* normal, int threads) {
  evaluate(part, position, normal);
  completeNormals(surface, part,
                  Eigen::Map<Points>(normal, static_cast<Eigen::Index>(part.size()), 3), threads);
}

void evaluatePoints(const LimitSurface& surface, Tessellation& result, int threads,
                    const Progress& progress) {
  const std::size_t count = result.locations.size();
  resizeRows(result.positions, count);
  resizeRows(result.normals, count);
  PartEvaluator evaluate(surface, count, threads);
  forEachPart(result.locations, [&](std::size_t begin, Span<Location> part) {
    evaluatePart(surface, evaluate, part, result.positions.data() + 3 * begin,
                 result.normals.data() + 3 * begin, threads);
    progress(static_cast<double>(begin + part.size()) / static_cast<double>(count));
  });
}

/// Evaluates the normals of corners. A corner has the normal of its point if both are on the same
/// Ptex face.
void evaluateCornerNormals(const LimitSurface& surface, Tessellation& result, int threads,
                           const Progress& progress) {
  resizeRows(result.corner_normals, result.face_vertices.size());
  std::vector<Location> others;
  std::vector<Eigen::Index> rows;
  std::size_t corner = 0;
  InterruptionStride stride;
  for (std::size_t polygon = 0; polygon < result.face_sizes.size(); ++polygon) {
    stride.step();
    const int face = result.ptex_face[polygon];
    for (int k = 0; k < result.face_sizes[polygon]; ++k, ++corner) {
      const int point = result.face_vertices[corner];
      const auto row = static_cast<Eigen::Index>(corner);
      if (result.locations[point].face == face) {
        result.corner_normals.row(row) = result.normals.row(point);
      } else {
        others.push_back(result.cornerLocation(polygon, corner));
        rows.push_back(row);
      }
    }
  }
  PartEvaluator evaluate(surface, others.size(), threads);
  const auto most = static_cast<Eigen::Index>(std::min(PartEvaluator::kMostRows, others.size()));
  Points position(most, 3), normal(most, 3);
  forEachPart(others, [&](std::size_t begin, Span<Location> part) {
    evaluatePart(surface, evaluate, part, position.data(), normal.data(), threads);
    for (std::size_t i = 0; i < part.size(); ++i) {
      result.corner_normals.row(rows[begin + i]) = normal.row(static_cast<Eigen::Index>(i));
    }
    progress(static_cast<double>(begin + part.size()) / static_cast<double>(others.size()));
  });
}

/// tessellate() for levels that are allowed. `whose` names them in error messages.
Tessellation tessellateAs(const LimitSurface& surface, const std::vector<int>& levels,
                          const std::string& whose, const TessellationOptions& options) {
  checkSize(leastPoints(surface.mesh(), levels), whose);
  const PtexFaces ptex(surface.mesh());
  const TessellationNumbers numbers(surface.mesh(), ptex, surface.refused(), levels,
                                    options.threads);
  checkSize(numbers.slotCount(), whose);
  checkSize(numbers.pointCount(), whose);
  Tessellation result;
  numbers.fill(result, options.threads);
  const double points_part = options.corner_normals ? kPointsPart : 1;
  const auto tell = [&](double part) {
    if (options.progress) {
      options.progress(part);
    }
  };
  evaluatePoints(surface, result, options.threads, [&](double part) { tell(part * points_part); });
  if (options.corner_normals) {
    evaluateCornerNormals(surface, result, options.threads,
                          [&](double part) { tell(points_part + part * (1 - points_part)); });
  }
  return result;
}

}  // namespace

Location Tessellation::cornerLocation(std::size_t polygon, std::size_t corner) const {
  return {ptex_face[polygon], static_cast<double>(corners[corner].u) / Corner::kSteps,
          static_cast<double>(corners[corner].v) / Corner::kSteps};
}

Tessellation tessellate(const LimitSurface& surface, int levels,
                        const TessellationOptions& options) {
  checkThreads(options.threads);
  const ControlMesh& mesh = surface.mesh();
  const int least = surface.faceCount() == mesh.faceCount() ? 0 : 1;
  if (levels < least || levels > kMostTessellationLevels) {
    throw std::invalid_argument("levels is " + std::to_string(levels) + allowedLevels(least));
  }
  return tessellateAs(
      surface, std::vector<int>(static_cast<std::size_t>(mesh.faceCount()), levels),
      "levels is " + std::to_string(levels) + " on " + std::to_string(mesh.faceCount()) + " faces",
      options);
}

Tessellation tessellate(const LimitSurface& surface, std::vector<int> levels,
                        const TessellationOptions& options) {
  checkThreads(options.threads);
  const ControlMesh& mesh = surface.mesh();
  if (levels.size() != static_cast<std::size_t>(mesh.faceCount())) {
    throw std::invalid_argument("levels has " + std::to_string(levels.size()) + " values for " +
                                std::to_string(mesh.faceCount()) + " faces");
  }
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const int least = mesh.faceSize(face) == 4 ? 0 : 1;
    int& level = levels[static_cast<std::size_t>(face)];
    if (surface.refused().count(face)) {
      level = least;
    } else if (level < least || level > kMostTessellationLevels) {
      throw std::invalid_argument("levels: face " + std::to_string(face) + ", of " +
                                  std::to_string(mesh.faceSize(face)) + " corners, has level " +
                                  std::to_string(level) + allowedLevels(least));
    }
  }
  return tessellateAs(surface, levels, "levels", options);
}

}  // namespace limitsurf
