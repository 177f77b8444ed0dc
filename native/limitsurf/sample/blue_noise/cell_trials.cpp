// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/cell_trials.h"

#include <algorithm>
#include <limits>

#include "limitsurf/random_bits.h"

namespace limitsurf {

void CellTrials::make(Span<TrialCell> cells, Outcome& out) {
  for (std::size_t begin = 0, end; begin < cells.size(); begin = end) {
    stride_.step();
    end = begin + 1;
    if (cells[begin].piece.isCore()) {
      makeInCore(cells[begin], out);
      continue;
    }
    const std::size_t most = std::min(cells.size(), begin + PlaceBlock::kCount);
    while (end < most && cells[end].piece == cells[begin].piece) {
      ++end;
    }
    makeInPatch(cells.subspan(begin, end - begin), out);
  }
}

void CellTrials::makeInPatch(Span<TrialCell> cells, Outcome& out) {
  const BoundedPatch& patch = splitting_.patchOf(cells[0]);
  const std::uint64_t key = cells[0].pieceKey(key_);
  PlaceBlock places;
  ExtentBlock extents;
  std::uint64_t bits[PlaceBlock::kCount];
  for (std::size_t i = 0; i < PlaceBlock::kCount; ++i) {
    // Every place has to hold numbers.
    const TrialCell& cell = cells[std::min(i, cells.size() - 1)];
    cell.putMiddle(extents, static_cast<int>(i));
    bits[i] = cell.bits(key);
    places.s[i] = (cell.column + uniformIn01(mixed(bits[i]))) * cell.width();
    places.t[i] = (cell.row + uniformIn01(mixed(bits[i] + 1))) * cell.height();
  }
  NoiseKernels::get().places(patch.patch(), places);
  splitting_.accepted().prepare(places, cells.size());
  bool has_extents = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const TrialCell& cell = cells[i];
    double smallest;
    if (!surface_.radii.smallestOn([&] { return patch.rectangle(cell); }, smallest)) {
      continue;
    }
    NoiseDisc disc;
    disc.position = {places.position[0][i], places.position[1][i], places.position[2][i]};
    disc.normal = {places.normal[0][i], places.normal[1][i], places.normal[2][i]};
    const double area = places.area[i];
    const auto at = [&] { return patch.patch().on.at(places.s[i], places.t[i]); };
    const bool has_room = !patch.vanishes(area) && findRadius(at, disc);
    splitting_.accepted().near(disc.position, has_room ? disc.radius : smallest);
    if (has_room && isCandidate(disc)) {
      add(disc, area * cell.width() * cell.height(), bits[i], {at(), cell}, out);
      continue;
    }
    if (!has_extents) {
      patch.findExtents(extents);
      has_extents = true;
    }
    splitting_.split(cell, patch, patch.extent(extents, static_cast<int>(i)), smallest, out.parts);
  }
}

void CellTrials::makeInCore(const TrialCell& core, Outcome& out) {
  double smallest;
  if (splitting_.isEmptyCore(core, smallest)) {
    return;
  }
  const std::uint64_t bits = core.bits(core.pieceKey(key_));
  NoiseDisc disc;
  Location at;
  const double area =
      findInCore(core.piece, uniformIn01(mixed(bits)), uniformIn01(mixed(bits + 1)), disc, at);
  const bool has_room = area > 0 && findRadius([&] { return at; }, disc);
  splitting_.accepted().near(disc.position, has_room ? disc.radius : smallest);
  if (has_room && isCandidate(disc)) {
    add(disc, area, bits, {at, core}, out);
  } else {
    splitting_.splitCore(core, smallest, out.parts);
  }
}

double CellTrials::findInCore(const SurfacePiece& core, double s, double t, NoiseDisc& disc,
                              Location& at) const {
  SurfacePiece piece = core;
  double size = 1;
  do {
    ++piece.steps;
    size /= 2;
    s *= 2;
    t *= 2;
  } while (std::max(s, t) < 1 && piece.steps < SurfacePatches::kMostSteps);
  const bool right = s >= 1, top = t >= 1;
  piece.part = static_cast<std::int16_t>(right && top ? 1 : top ? 2 : 0);
  const BezierPatch patch = surface_.patches.patch(piece);
  BezierPatch::Values values;
  s = std::clamp(piece.part == 2 ? s : s - 1, 0., 1.);
  t = std::clamp(piece.part == 0 ? t : t - 1, 0., 1.);
  patch.evaluate<1>(s, t, values);
  disc.position = (values.value + patch.anchor).head<3>().matrix();
  const Vector3 normal = cross(values.ds, values.dt);
  at = patch.on.at(s, t);
  const double area = length(normal);
  disc.normal = normal / area;
  const bool vanishes =
      !(area > BoundedPatch::kCrossRounding * length(values.ds) * length(values.dt));
  return vanishes ? 0 : area / (size * size);
}

template <typename At>
bool CellTrials::findRadius(const At& at, NoiseDisc& disc) const {
  disc.radius = surface_.radii.areEqual() ? surface_.radii.smallest() : surface_.radii.at(at());
  return disc.radius > 0;
}

bool CellTrials::isCandidate(NoiseDisc& disc) {
  disc.rank = 0;  // accepted points come first
  return !splitting_.accepted().last().conflict(disc, 0);
}

void CellTrials::add(NoiseDisc& disc, double area, std::uint64_t bits, const Candidate& candidate,
                     Outcome& out) {
  // Ranks are the times at which candidates would arrive if points fell on the whole surface one
  // after the other: a large cell is hit sooner than a small one.
  disc.rank = std::min(uniformIn01(mixed(bits + 2)) * disc.radius * disc.radius / area,
                       std::numeric_limits<double>::max());
  out.discs.push_back(disc);
  out.candidates.push_back(candidate);
}

}  // namespace limitsurf
