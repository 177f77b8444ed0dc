// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_sampler.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/sample/area_sampler_data.h"
#include "limitsurf/sample/limited_cells.h"
#include "limitsurf/sample/thinning.h"
#include "limitsurf/sample/uniform_candidates.h"

namespace limitsurf {
namespace {

/// More locations than this fit into no machine's memory.
constexpr std::int64_t kMostLocations = std::int64_t{1} << 40;
/// The number of samples between two calls of Progress.
constexpr std::size_t kSamplesPerReport = std::size_t{1} << 18;

/// The first accepted candidate of each sample.
std::vector<Location> allAccepted(const UniformCandidates& candidates, std::size_t count,
                                  int threads, const Progress& progress) {
  std::vector<Location> result;
  resizeInParts(result, count);
  for (std::size_t first = 0; first < count; first += kSamplesPerReport) {
    report(progress, first, count);
    candidates.findFirst(first, std::min(kSamplesPerReport, count - first), result.data() + first,
                         threads);
  }
  report(progress, 1, 1);
  return result;
}

/// At most this many faces are read in advance.
constexpr std::size_t kPilotFaces = 200000;

/// The corners and middles of faces that have a surface, of about kPilotFaces of them at most.
std::vector<Location> pilotLocations(const std::vector<bool>& has_surface) {
  const std::size_t stride = has_surface.size() / kPilotFaces + 1;
  std::vector<Location> at;
  for (std::size_t face = 0; face < has_surface.size(); face += stride) {
    if (has_surface[face]) {
      for (const double v : {0., 1.}) {
        for (const double u : {0., 1.}) {
          at.push_back({static_cast<int>(face), u, v});
        }
      }
      at.push_back({static_cast<int>(face), 0.5, 0.5});
    }
  }
  return at;
}

}  // namespace

std::vector<bool> AreaSampler::Data::hasSurface() const {
  std::vector<bool> result(static_cast<std::size_t>(surface.faceCount()), false);
  std::vector<SurfacePiece> pieces;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    result[static_cast<std::size_t>(patches.rectangle(pieces.front()).face)] = true;
  }
  return result;
}

std::vector<Location> AreaSampler::Data::ofFunction(std::size_t count, std::uint64_t seed,
                                                    const Density& density, int threads,
                                                    const Progress& progress) const {
  const DensityField constant;
  const DensityLimits& limits = density.limits();
  if (!limits.areKnown()) {
    const UniformCandidates candidates(patches, cells, uniform, constant, seed);
    Thinning thinning(candidates, density, 1, count, threads, progress);
    thinning.pilot(pilotLocations(hasSurface()));
    return thinning.run();
  }
  checkLimits(limits, hasSurface());
  LimitedCells limited = limitedCells(patches, cells, limits, threads);
  const CellTable table(limited.cells, std::move(limited.largest));
  if (!(table.total() > 0)) {
    throw std::invalid_argument(zeroEverywhereText(0));
  }
  const UniformCandidates candidates(patches, limited.cells, table, constant, seed);
  return Thinning(candidates, density, limited.unit, count, threads, progress).run();
}

void AreaSampler::Data::checkLimits(const DensityLimits& limits,
                                    const std::vector<bool>& has_surface) const {
  if (!limits.areKnown()) {
    return;
  }
  if (limits.faceCount() != surface.faceCount()) {
    throw std::invalid_argument("density_limits are for " + std::to_string(limits.faceCount()) +
                                " faces; the surface has " + std::to_string(surface.faceCount()));
  }
  double largest = 0;
  for (std::size_t face = 0; face < has_surface.size(); ++face) {
    if (has_surface[face]) {
      largest = std::max(largest, limits.on(static_cast<int>(face), 0, 1, 0, 1).largest);
    }
  }
  if (!(largest > 0)) {
    throw std::invalid_argument(zeroEverywhereText(0));
  }
}

AreaSampler::AreaSampler(const LimitSurface& surface, int threads)
    : data_(std::make_unique<Data>(surface, threads)) {}
AreaSampler::~AreaSampler() = default;
AreaSampler::AreaSampler(AreaSampler&&) noexcept = default;
AreaSampler& AreaSampler::operator=(AreaSampler&&) noexcept = default;

std::vector<Location> AreaSampler::uniform(std::int64_t count, std::uint64_t seed,
                                           const Density& density, int threads,
                                           const Progress& progress) const {
  if (count < 0 || count > kMostLocations) {
    throw std::invalid_argument("count is " + std::to_string(count) + "; it must be 0 to " +
                                std::to_string(kMostLocations));
  }
  if (count == 0) {
    return {};
  }
  if (!data_->hasArea()) {
    throw std::invalid_argument("the surface has no area");
  }
  const std::size_t samples = static_cast<std::size_t>(count);
  if (density.function()) {
    return data_->ofFunction(samples, seed, density, threads, progress);
  }
  const DensityField field(density);
  if (field.isConstant()) {
    return allAccepted(UniformCandidates(data_->patches, data_->cells, data_->uniform, field, seed),
                       samples, threads, progress);
  }
  const CellTable table(data_->cells,
                        largestDensities(data_->patches, data_->cells, field, threads));
  if (!(table.total() > 0)) {
    throw std::invalid_argument("density is 0 everywhere on the surface");
  }
  return allAccepted(UniformCandidates(data_->patches, data_->cells, table, field, seed), samples,
                     threads, progress);
}

}  // namespace limitsurf
