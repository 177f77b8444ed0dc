// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/sample/density.h"
#include "limitsurf/sample/uniform_candidates.h"

namespace limitsurf {

/// Accepts candidates by a density function. Where the function has limits, candidates come in
/// proportion to area times the limit on their cell, and one is accepted with the probability
/// density / limit. Else the largest value is unknown: the largest one seen so far stands for it,
/// and whenever a larger one appears, the samples accepted before are tested anew.
class Thinning {
 public:
  /// `candidates`: with the limits in their table, as parts of `unit`; without limits both are 1.
  Thinning(const UniformCandidates& candidates, const Density& density, double unit,
           std::size_t count, int threads, const Progress& progress);

  /// Reads the function at these locations before any candidate's, to find a large value early.
  void pilot(Span<Location> at);

  /// One accepted candidate for each sample. Throws std::invalid_argument for a density that is
  /// negative, not finite, larger than its limit, or 0 at the first kMostZeros candidates, and if
  /// kMostRejected candidates in succession are rejected.
  std::vector<Location> run();

 private:
  struct Trial {
    double limit = 1;
    double weight = 0;  ///< the density; as a part of the limit on the candidate's cell, if known
    double test = 0;    ///< accepted if below weight / largest weight
    std::uint32_t attempt = 0;  ///< the number of the sample's next candidate
  };
  struct Sample {
    Location at;
    Trial trial;

    bool accepted(double largest) const { return trial.test * largest < trial.weight; }
  };

  /// Replaces these samples by their next candidates that are accepted, and lists those of which
  /// there are none among the next few.
  void tryNext(Span<std::size_t> open, std::vector<std::size_t>& still_open);
  /// Lists all samples that are rejected under the present maximum, which has become larger.
  void reopen(std::vector<std::size_t>& open) const;

  /// A density that is 0 at this many locations is taken to be 0 everywhere.
  static constexpr std::size_t kMostZeros = std::size_t{1} << 20;
  /// Calls in which one candidate of a million is accepted succeed with near certainty; others
  /// might not end within hours.
  static constexpr std::size_t kMostRejected = std::size_t{1} << 25;

  const UniformCandidates& candidates_;
  const Density& density_;
  const DensityLimits& limits_;
  double unit_;
  int threads_;
  const Progress& progress_;
  std::vector<Sample> samples_;
  double largest_;       // the largest weight that has been seen; 1 with limits
  bool is_zero_ = true;  // at all locations so far
  std::size_t asked_ = 0;
  std::size_t rejected_ = 0;     // candidates since one was accepted
  double largest_rejected_ = 0;  // the largest weight of these
};

}  // namespace limitsurf
