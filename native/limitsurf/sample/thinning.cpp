// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/thinning.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The number of samples between two calls of Progress, and the number that one task takes.
constexpr std::size_t kSamplesPerReport = std::size_t{1} << 18;
constexpr std::size_t kSamplesPerTask = 2048;
/// The function is asked for at least about this many values at a time, because a call of a Python
/// function takes as long as the values of some hundred locations.
constexpr std::size_t kFewest = 1024;

}  // namespace

Thinning::Thinning(const UniformCandidates& candidates, const Density& density, double unit,
                   std::size_t count, int threads, const Progress& progress)
    : candidates_(candidates),
      density_(density),
      limits_(density.limits()),
      unit_(unit),
      threads_(threads),
      progress_(progress),
      largest_(limits_.areKnown() ? 1 : 0) {
  resizeInParts(samples_, count);
}

void Thinning::pilot(Span<Location> at) {
  for (std::size_t first = 0; first < at.size(); first += kSamplesPerReport) {
    const auto part = at.subspan(first, std::min(kSamplesPerReport, at.size() - first));
    for (const double weight : density_.weights(part)) {
      largest_ = std::max(largest_, weight);
    }
    is_zero_ = largest_ == 0;
    InterruptionPoint::pass();
  }
  asked_ = at.size();
}

std::vector<Location> Thinning::run() {
  std::vector<std::size_t> open;
  resizeInParts(open, samples_.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    open[i] = i;
  }
  while (!open.empty()) {
    const double before = largest_;
    std::vector<std::size_t> still_open;
    for (std::size_t first = 0; first < open.size(); first += kSamplesPerReport) {
      report(progress_, samples_.size() - (open.size() - first) - still_open.size(),
             samples_.size());
      tryNext(
          Span<std::size_t>(open).subspan(first, std::min(kSamplesPerReport, open.size() - first)),
          still_open);
    }
    open.swap(still_open);
    if (largest_ > before) {
      reopen(open);
    }
  }
  report(progress_, 1, 1);
  std::vector<Location> result;
  resizeInParts(result, samples_.size());
  std::transform(samples_.begin(), samples_.end(), result.begin(),
                 [](const Sample& sample) { return sample.at; });
  return result;
}

void Thinning::tryNext(Span<std::size_t> open, std::vector<std::size_t>& still_open) {
  const std::size_t ahead = std::max<std::size_t>(kFewest / open.size(), 1);
  std::vector<Trial> trials(open.size() * ahead);
  std::vector<Location> at(trials.size());
  parallelFor(
      open.size(), kSamplesPerTask / ahead + 1, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          std::uint32_t attempt = samples_[open[i]].trial.attempt;
          for (std::size_t j = i * ahead; j < (i + 1) * ahead; ++j) {
            const UniformCandidates::Candidate candidate = candidates_.next(open[i], attempt);
            at[j] = candidate.at;
            trials[j].limit = candidate.largest * unit_;
            trials[j].test = candidates_.number(open[i], attempt);
            trials[j].attempt = attempt;
          }
        }
      });
  const std::vector<double> weights = density_.weights(at);
  asked_ += at.size();
  double largest_weight = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    trials[i].weight = weights[i] / trials[i].limit;
    largest_weight = std::max(largest_weight, weights[i]);
  }
  is_zero_ = is_zero_ && largest_weight == 0;
  if (is_zero_ && asked_ >= kMostZeros) {
    throw std::invalid_argument(zeroEverywhereText(asked_));
  }
  if (!limits_.areKnown()) {
    largest_ = std::max(largest_, largest_weight);
  }
  rejected_ += at.size();
  largest_rejected_ = std::max(largest_rejected_, largest_weight);
  for (std::size_t i = 0; i < open.size(); ++i) {
    Sample& sample = samples_[open[i]];
    for (std::size_t j = i * ahead; j < (i + 1) * ahead; ++j) {
      sample = {at[j], trials[j]};
      if (sample.accepted(largest_)) {
        break;
      }
    }
    if (!sample.accepted(largest_)) {
      still_open.push_back(open[i]);
    } else {
      rejected_ = 0;
      largest_rejected_ = 0;
    }
  }
  if (rejected_ >= kMostRejected) {
    throw std::invalid_argument(
        tooFewAcceptedText(rejected_, largest_rejected_, limits_.areKnown() ? unit_ : 0));
  }
}

void Thinning::reopen(std::vector<std::size_t>& open) const {
  open.clear();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!samples_[i].accepted(largest_)) {
      open.push_back(i);
    }
  }
}

}  // namespace limitsurf
