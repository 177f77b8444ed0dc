// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/guide_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/geodesic/geodesic_mesh.h"
#include "limitsurf/geodesic/guide_levels.h"
#include "limitsurf/geodesic/kept_sources.h"
#include "limitsurf/geodesic/nearest_sources.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Vertices know more guides than a place gets, because its own nearest are not all among theirs.
constexpr int kSpare = 5;
constexpr std::size_t kRowsPerPart = std::size_t{1} << 16;
/// Parts of the progress: triangles, distances, places.
constexpr double kTriangles = 0.1, kDistances = 0.6;

Progress partOf(const Progress& progress, double begin, double end) {
  if (!progress) {
    return [](double) {};
  }
  return [&progress, begin, end](double part) { progress(begin + part * (end - begin)); };
}

std::vector<MeshPlace> placesOn(const LimitSurface& surface, const GeodesicMesh& mesh,
                                const LocationBatch& at, int threads) {
  const Points positions = surface.evaluate(at, Derivatives::none, false, threads).position;
  std::vector<MeshPlace> places(at.size());
  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Vector3 position = positions.row(static_cast<Eigen::Index>(row));
      places[row] = {position, mesh.triangleUnder(position, mesh.triangleAt(at[row]))};
    }
  });
  return places;
}

/// Fills one row of the result.
void choose(std::vector<NearestSources::Entry>& found, std::size_t row, GuideWeights& result) {
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.source < b.source;
  });
  const std::size_t count = static_cast<std::size_t>(result.count);
  const std::size_t used = std::min(found.size(), count), first = row * count;
  for (std::size_t k = 0; k < used; ++k) {
    result.guide[first + k] = found[k].source;
    result.distance[first + k] = found[k].distance;
  }
  const double end =
      found.size() > count ? found[count].distance : std::numeric_limits<double>::infinity();
  weightsByDistance(&result.distance[first], static_cast<int>(used), end, &result.weight[first]);
}

}  // namespace

void weightsByDistance(const double* distances, int count, double end, double* weights) {
  if (count == 0) {
    return;
  }
  double sum = 0;
  for (int k = 0; k < count; ++k) {
    // relative to the nearest, whose distance may be 0
    const double nearness = distances[k] > 0 ? distances[0] / distances[k] : 1;
    const double fade = std::isfinite(end) && end > 0 ? 1 - distances[k] / end : 1;
    weights[k] = nearness * nearness * fade * fade;
    sum += weights[k];
  }
  for (int k = 0; k < count; ++k) {
    weights[k] = sum > 0 ? weights[k] / sum : 1. / count;
  }
}

GuideWeights guideWeights(const LimitSurface& surface, const LocationBatch& guides,
                          const LocationBatch& at, const GuideOptions& options) {
  checkThreads(options.threads);
  if (options.count < 1 || options.count > GuideOptions::kMostGuides) {
    throw std::invalid_argument("count is " + std::to_string(options.count) + "; expected 1 to " +
                                std::to_string(GuideOptions::kMostGuides));
  }
  if (!options.cut_curves.offsets.empty() || options.cut_curves.points.rows() > 0) {
    checkPolylines(options.cut_curves, "cut_points", "cut_offsets");
  }
  const LocationBatch checked_guides = surface.checkLocations(guides, options.threads);
  const LocationBatch checked = surface.checkLocations(at, options.threads);
  GuideWeights result;
  result.count = options.count;
  const std::size_t size = at.size() * static_cast<std::size_t>(options.count);
  result.guide.assign(size, -1);
  result.weight.assign(size, 0);
  result.distance.assign(size, std::numeric_limits<double>::infinity());

  const GeodesicCuts cuts{options.cuts, options.cut_curves};
  const GeodesicMesh mesh(surface, guideLevels(surface, checked_guides, cuts), cuts,
                          options.threads, partOf(options.progress, 0, kTriangles));
  const std::vector<MeshPlace> sources = placesOn(surface, mesh, checked_guides, options.threads);
  const NearestSources nearest(mesh, sources, keptSources(mesh, sources, options.count, kSpare),
                               partOf(options.progress, kTriangles, kDistances));
  const Progress tell = partOf(options.progress, kDistances, 1);
  for (std::size_t begin = 0; begin < at.size(); begin += kRowsPerPart) {
    const std::size_t rows = std::min(kRowsPerPart, at.size() - begin);
    const std::vector<MeshPlace> places =
        placesOn(surface, mesh, checked.rows(begin, rows), options.threads);
    parallelFor(rows, kRowsPerTask, options.threads, [&](std::size_t first, std::size_t last) {
      std::vector<NearestSources::Entry> found;
      for (std::size_t row = first; row < last; ++row) {
        nearest.find(places[row], found);
        choose(found, begin + row, result);
      }
    });
    tell(static_cast<double>(begin + rows) / static_cast<double>(at.size()));
  }
  return result;
}

}  // namespace limitsurf
