// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_sampler.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_sampler_data.h"
#include "limitsurf/sample/uniform_candidates.h"

namespace limitsurf {
namespace {

/// More locations than this fit into no machine's memory.
constexpr std::int64_t kMostLocations = std::int64_t{1} << 40;
/// The number of samples between two calls of Progress, and the number that one task takes.
constexpr std::size_t kSamplesPerReport = std::size_t{1} << 18;
constexpr std::size_t kSamplesPerTask = 2048;

void report(const Progress& progress, std::size_t done, std::size_t all) {
  if (progress) {
    progress(static_cast<double>(done) / static_cast<double>(all));
  }
}

/// The first accepted candidate of each sample.
std::vector<Location> allAccepted(const UniformCandidates& candidates, std::size_t count,
                                  int threads, const Progress& progress) {
  std::vector<Location> result(count);
  for (std::size_t first = 0; first < count; first += kSamplesPerReport) {
    report(progress, first, count);
    candidates.findFirst(first, std::min(kSamplesPerReport, count - first), result.data() + first,
                         threads);
  }
  report(progress, 1, 1);
  return result;
}

/// Accepts candidates by a density function whose largest value is unknown: the largest value seen
/// so far stands for it, and whenever a larger one appears, the samples accepted before are tested
/// anew.
class Thinning {
 public:
  Thinning(const UniformCandidates& candidates, const Density& density, std::size_t count,
           int threads, const Progress& progress)
      : candidates_(candidates),
        density_(density),
        threads_(threads),
        progress_(progress),
        samples_(count) {}

  /// Reads the function at these locations before any candidate's, to find a large value early.
  void pilot(Span<Location> at) {
    for (std::size_t first = 0; first < at.size(); first += kSamplesPerReport) {
      const auto part = at.subspan(first, std::min(kSamplesPerReport, at.size() - first));
      for (const double weight : density_.weights(part)) {
        largest_ = std::max(largest_, weight);
      }
      InterruptionPoint::pass();
    }
    asked_ = at.size();
  }

  std::vector<Location> run() {
    std::vector<std::size_t> open(samples_.size());
    for (std::size_t i = 0; i < open.size(); ++i) {
      open[i] = i;
    }
    while (!open.empty()) {
      const double before = largest_;
      std::vector<std::size_t> still_open;
      for (std::size_t first = 0; first < open.size(); first += kSamplesPerReport) {
        report(progress_, samples_.size() - (open.size() - first) - still_open.size(),
               samples_.size());
        tryNext(Span<std::size_t>(open).subspan(first,
                                                std::min(kSamplesPerReport, open.size() - first)),
                still_open);
      }
      open.swap(still_open);
      if (largest_ > before) {
        reopen(open);
      }
    }
    report(progress_, 1, 1);
    std::vector<Location> result(samples_.size());
    std::transform(samples_.begin(), samples_.end(), result.begin(),
                   [](const Sample& sample) { return sample.at; });
    return result;
  }

 private:
  struct Sample {
    Location at;
    double weight = 0;
    double test = 0;  ///< accepted if below weight / largest weight
    std::uint32_t attempt = 0;

    bool accepted(double largest) const { return test * largest < weight; }
  };

  /// Replaces these samples by their next candidates, and lists those that are rejected again.
  void tryNext(Span<std::size_t> open, std::vector<std::size_t>& still_open) {
    std::vector<Location> at(open.size());
    parallelFor(open.size(), kSamplesPerTask, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Sample& sample = samples_[open[i]];
        at[i] = sample.at = candidates_.next(open[i], sample.attempt);
        sample.test = candidates_.number(open[i], sample.attempt);
      }
    });
    const std::vector<double> weights = density_.weights(at);
    for (std::size_t i = 0; i < open.size(); ++i) {
      samples_[open[i]].weight = weights[i];
      largest_ = std::max(largest_, weights[i]);
    }
    asked_ += open.size();
    if (largest_ == 0 && asked_ >= kMostZeros) {
      throw std::invalid_argument("density is 0 at all of " + std::to_string(asked_) +
                                  " locations");
    }
    for (const std::size_t i : open) {
      if (!samples_[i].accepted(largest_)) {
        still_open.push_back(i);
      }
    }
  }

  /// Lists all samples that are rejected under the present maximum, which has become larger.
  void reopen(std::vector<std::size_t>& open) const {
    open.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!samples_[i].accepted(largest_)) {
        open.push_back(i);
      }
    }
  }

  /// A density that is 0 at this many locations is taken to be 0 everywhere.
  static constexpr std::size_t kMostZeros = std::size_t{1} << 20;

  const UniformCandidates& candidates_;
  const Density& density_;
  int threads_;
  const Progress& progress_;
  std::vector<Sample> samples_;
  double largest_ = 0;
  std::size_t asked_ = 0;
};

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
    const DensityField constant;
    const UniformCandidates candidates(data_->patches, data_->cells, data_->uniform, constant,
                                       seed);
    Thinning thinning(candidates, density, samples, threads, progress);
    thinning.pilot(pilotLocations(data_->hasSurface()));
    return thinning.run();
  }
  const DensityField field(density);
  if (field.isConstant()) {
    return allAccepted(UniformCandidates(data_->patches, data_->cells, data_->uniform, field, seed),
                       samples, threads, progress);
  }
  const CellTable table(data_->patches, data_->cells, field, threads);
  if (!(table.total() > 0)) {
    throw std::invalid_argument("density is 0 everywhere on the surface");
  }
  return allAccepted(UniformCandidates(data_->patches, data_->cells, table, field, seed), samples,
                     threads, progress);
}

}  // namespace limitsurf
