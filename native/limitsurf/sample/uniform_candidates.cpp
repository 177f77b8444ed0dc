// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/uniform_candidates.h"

#include <algorithm>
#include <numeric>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/concatenation.h"
#include "limitsurf/sample/core_tail.h"

namespace limitsurf {
namespace {

/// The number of samples that one task takes.
constexpr std::size_t kSamplesPerTask = 2048;
/// Fewer samples than these are not sorted.
constexpr std::size_t kFewSamples = 256;
/// Samples are sorted into parts of the surface with about this many each.
constexpr std::size_t kSamplesPerPart = 4;

}  // namespace

UniformCandidates::Candidate UniformCandidates::next(std::size_t sample,
                                                     std::uint32_t& attempt) const {
  const std::uint64_t stream = streamOf(sample);
  KeptPatch kept;
  Candidate candidate;
  while (!accept(stream + kNumbers * attempt++, kept, candidate)) {
  }
  return candidate;
}

void UniformCandidates::findFirst(std::size_t first, std::size_t count, Location* out,
                                  int threads) const {
  std::vector<Open> open(count);
  for (std::size_t i = 0; i < count; ++i) {
    open[i] = {static_cast<std::uint32_t>(i), 0};
  }
  while (open.size() > kFewSamples) {
    const std::vector<Open> order = sorted(open, first, threads);
    open = concatenated<Open>(order.size(), kSamplesPerTask, threads,
                              [&](std::size_t begin, std::size_t end, std::vector<Open>& rejected) {
                                KeptPatch kept;
                                Candidate candidate;
                                for (; begin < end; ++begin) {
                                  const Open& sample = order[begin];
                                  const std::uint64_t stream = streamOf(first + sample.sample);
                                  if (accept(stream + kNumbers * sample.attempt, kept, candidate)) {
                                    out[sample.sample] = candidate.at;
                                  } else {
                                    rejected.push_back({sample.sample, sample.attempt + 1});
                                  }
                                }
                              });
  }
  for (Open& sample : open) {
    out[sample.sample] = next(first + sample.sample, sample.attempt).at;
  }
}

std::vector<UniformCandidates::Open> UniformCandidates::sorted(const std::vector<Open>& open,
                                                               std::size_t first,
                                                               int threads) const {
  const std::size_t parts = open.size() / kSamplesPerPart;
  std::vector<std::uint32_t> part(open.size());
  parallelFor(open.size(), kSamplesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The number by which accept() picks the cell.
      const std::uint64_t stream = streamOf(first + open[i].sample) + kNumbers * open[i].attempt;
      part[i] = static_cast<std::uint32_t>(uniformIn01(mixed(stream)) * static_cast<double>(parts));
    }
  });
  std::vector<std::uint32_t> place(parts + 1, 0);
  for (const std::uint32_t i : part) {
    ++place[i + 1];
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Open> result(open.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    result[place[part[i]]++] = open[i];
  }
  return result;
}

bool UniformCandidates::accept(std::uint64_t stream, KeptPatch& kept, Candidate& out) const {
  const CellTable::Choice choice = table_.pick(uniformIn01(mixed(stream)));
  const AreaCell& cell = cells_[choice.cell];
  out.largest = table_.largest(choice.cell);
  double s = uniformIn01(mixed(stream + 1)), t = uniformIn01(mixed(stream + 2));
  const double test = uniformIn01(mixed(stream + 3));
  SurfacePiece piece = cell.piece;
  double bound = cell.bound, size = 1;
  if (piece.isCore()) {
    if (!pickFromCore(cell, choice.rest, piece, bound)) {
      return false;
    }
  } else if (cell.level > 0) {
    const double side = 1. / (1 << cell.level);
    s = side * (cell.column + s);
    t = side * (cell.row + t);
    size = side * side;
  }
  // Where the area is nowhere small enough for a rejection it need not be calculated.
  if (density_.isConstant() && test * bound < cell.least) {
    out.at = patches_.rectangle(piece).at(s, t);
    return true;
  }
  if (!(kept.piece == piece)) {
    kept = {piece, patches_.patch(piece)};
  }
  BezierPatch::Values values;
  kept.patch.evaluate<1>(s, t, values);
  const double area = length(cross(values.ds, values.dt)) * size;
  out.at = kept.patch.on.at(s, t);
  return density_.isConstant() ? test * bound < area
                               : test * bound * out.largest < area * density_.at(out.at);
}

bool UniformCandidates::pickFromCore(const AreaCell& cell, double number, SurfacePiece& piece,
                                     double& bound) const {
  double rest = number * cell.bound;
  RingPitches pitches(patches_, cell.piece);
  CoreTail tail(pitches, cell.piece.steps, Vector3(cell.outer[0], cell.outer[1], cell.outer[2]));
  for (; !tail.ended() && rest >= 3 * tail.bound(); tail.step()) {
    rest -= 3 * tail.bound();
  }
  bound = tail.bound();
  if (tail.ended() || !(bound > 0)) {
    return false;
  }
  piece.steps = static_cast<std::int16_t>(tail.steps() + 1);
  piece.part = static_cast<std::int16_t>(std::min(static_cast<int>(rest / bound), 2));
  return true;
}

}  // namespace limitsurf
