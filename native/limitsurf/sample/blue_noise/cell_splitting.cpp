// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/cell_splitting.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace limitsurf {
namespace {

/// The first cells have a reach of at most this many radii. Chosen for speed: parts of a cell that
/// a disc covers are never made, so that large cells save many where faces are slivers. With cells
/// much larger than discs there are more rounds, each with few points.
constexpr double kFirstReach = 3;
/// A cell more than this many times as long as wide is halved across its longer side only.
constexpr double kOblong = 1.5;
/// What discs on the sheets of a fold leave out of a cell may be a strip of this part of a gap's
/// width. Neighbouring cells may each leave out a strip, and smaller strips make it less likely
/// that a point falls into one of them.
constexpr double kStrip = 1. / 256;

bool isCloser(const NoiseDisc& disc, const Vector3& middle, double reach, double smallest) {
  return length(Vector3(disc.position - middle)) + reach < (disc.radius + smallest) / 2;
}

/// The quarters of a cell, or its halves.
class Parts {
 public:
  Parts(const TrialCell& cell, const CellExtent& extent)
      : cell_(cell),
        along_s_(!(extent.along_t > kOblong * extent.along_s) &&
                 cell.s_level < TrialCell::kMostLevels),
        along_t_(!(extent.along_s > kOblong * extent.along_t) &&
                 cell.t_level < TrialCell::kMostLevels) {}

  unsigned count() const {
    return along_s_ || along_t_ ? (along_s_ ? 2u : 1u) * (along_t_ ? 2u : 1u) : 0;
  }
  TrialCell at(unsigned part) const {
    const TrialCell strip = along_t_ ? cell_.halfOfT(tOf(part)) : cell_;
    return along_s_ ? strip.halfOfS(sOf(part)) : strip;
  }
  /// Adds where they are, as far as the extent of the whole cell tells.
  void addTo(CellParts& parts, const CellExtent& extent) const {
    const double s_part = along_s_ ? 0.5 : 0, t_part = along_t_ ? 0.5 : 0;
    const Vector3 s_off = s_part * extent.half_s, t_off = t_part * extent.half_t;
    const double corner =
        along_s_ && along_t_
            ? extent.corner / 2
            : CellExtent::cornerReach((1 - s_part) * extent.half_s, (1 - t_part) * extent.half_t);
    const double reach = corner + extent.bend;
    for (unsigned part = 0; part < count(); ++part) {
      const Vector3 off = (sOf(part) == 0 ? -1. : 1.) * s_off + (tOf(part) == 0 ? -1. : 1.) * t_off;
      parts.add(extent.middle + off, reach);
    }
  }

 private:
  unsigned sOf(unsigned part) const { return along_s_ ? part % 2 : 0; }
  unsigned tOf(unsigned part) const { return along_s_ ? part / 2 : part; }

  const TrialCell& cell_;
  bool along_s_, along_t_;
};

}  // namespace

const BoundedPatch& CellSplitting::patchOf(const TrialCell& cell) {
  if (!patch_ || !(cell.piece == piece_)) {
    piece_ = cell.piece;
    patch_.emplace(surface_.patches.patch(piece_));
  }
  return *patch_;
}

bool CellSplitting::isEmptyCore(const TrialCell& core, double& smallest) const {
  return core.piece.steps >= SurfacePatches::kMostSteps ||
         !surface_.radii.smallestOn([&] { return surface_.patches.rectangle(core.piece); },
                                    smallest);
}

void CellSplitting::begin(const SurfacePiece& piece, std::vector<TrialCell>& cells) {
  TrialCell cell;
  cell.piece = piece;
  if (piece.isCore()) {
    beginCore(cell, cells);
  } else {
    begin({&cell, 1}, patchOf(cell), cells);
  }
}

void CellSplitting::begin(Span<TrialCell> whole, const BoundedPatch& patch,
                          std::vector<TrialCell>& cells) {
  ExtentBlock extents;
  for (int i = 0; i < ExtentBlock::kCount; ++i) {
    whole[std::min(static_cast<std::size_t>(i), whole.size() - 1)].putMiddle(extents, i);
  }
  patch.findExtents(extents);
  std::vector<TrialCell> parts;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    stride_.step();
    double smallest;
    if (!surface_.radii.smallestOn([&] { return patch.rectangle(whole[i]); }, smallest)) {
      continue;
    }
    const CellExtent extent = patch.extent(extents, static_cast<int>(i));
    if (!(extent.reach() <= kFirstReach * smallest)) {
      parts.clear();
      split(whole[i], patch, extent, smallest, parts);
      if (!parts.empty()) {
        begin(parts, patch, cells);
      }
    } else if (accepted_.last().covered(extent.parts(smallest)) == 0) {
      cells.push_back(whole[i]);
      if (static_cast<double>(cells.size()) + static_cast<double>(surface_.first_cells) >
          surface_.most_first_cells) {
        throw std::invalid_argument(
            "faces are sheared or stretched so strongly that blue noise of this density would "
            "need far more memory than its points: choose a larger radius or a smaller count");
      }
    }
  }
}

void CellSplitting::split(const TrialCell& cell, const BoundedPatch& patch,
                          const CellExtent& extent, double smallest,
                          std::vector<TrialCell>& parts) {
  if (patch.vanishes(extent) || 2 * extent.reach() <= surface_.gap * smallest) {
    return;
  }
  const Parts halves(cell, extent);
  CellParts tested = extent.parts(smallest);
  halves.addTo(tested, extent);
  const unsigned covered = accepted_.last().covered(tested);
  if ((covered & 1) ||
      (BoundedPatch::mayTurnOver(extent) && isCoveredTogether(cell, patch, extent, smallest))) {
    return;
  }
  for (unsigned part = 0; part < halves.count(); ++part) {
    if (!(covered >> (part + 1) & 1)) {
      parts.push_back(halves.at(part));
    }
  }
}

bool CellSplitting::isCoveredTogether(const TrialCell& cell, const BoundedPatch& patch,
                                      const CellExtent& extent, double smallest) const {
  const NearDiscs& near = accepted_.last();
  std::optional<TurningNormals> normals;
  double low = 0, high = 0;  // discs see what is below and what is above
  for (std::size_t i = 0; i < near.size(); ++i) {
    const NoiseDisc disc = near[i];
    if (!isCloser(disc, extent.middle, extent.reach(), smallest)) {
      continue;
    }
    if (!normals) {
      normals = patch.turningNormals(cell);
      low = normals->low;
      high = normals->high;
    }
    if (disc.normal.dot(normals->axis) > 0) {
      high = std::min(high, normals->seenAbove(disc.normal, normals->axis));
    } else {
      low = std::max(low, -normals->seenAbove(disc.normal, -normals->axis));
    }
  }
  return normals &&
         (high <= low || normals->width * (high - low) <= kStrip * surface_.gap * smallest);
}

void CellSplitting::splitCore(const TrialCell& core, double smallest,
                              std::vector<TrialCell>& parts) {
  descent_.reset();
  const NearDiscs& near = accepted_.last();
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (coversCore(near[i], core, smallest)) {
      return;
    }
  }
  const SurfacePatches::SplitCore split = descentOf(core, smallest).firstSplit();
  beginSplit(split, smallest, parts);
}

void CellSplitting::findCovered(std::vector<Hit>& hits) {
  ExtentBlock extents;
  for (std::size_t begin = 0, end; begin < hits.size(); begin = end) {
    const TrialCell& first = *hits[begin].cell;
    end = begin + 1;
    if (first.piece.isCore()) {
      hits[begin].is_covered = coversCore(*hits[begin].disc, first);
      continue;
    }
    while (end < std::min(hits.size(), begin + ExtentBlock::kCount) &&
           hits[end].cell->piece == first.piece) {
      ++end;
    }
    const BoundedPatch& patch = patchOf(first);
    for (std::size_t i = 0; i < ExtentBlock::kCount; ++i) {
      hits[std::min(begin + i, end - 1)].cell->putMiddle(extents, static_cast<int>(i));
    }
    patch.findExtents(extents);
    for (std::size_t i = begin; i < end; ++i) {
      Hit& hit = hits[i];
      double smallest;
      if (!surface_.radii.smallestOn([&] { return patch.rectangle(*hit.cell); }, smallest)) {
        hit.is_covered = true;
        continue;
      }
      const CellExtent extent = patch.extent(extents, static_cast<int>(i - begin));
      hit.is_covered = isCloser(*hit.disc, extent.middle, extent.reach(), smallest) &&
                       extent.facesAll(hit.disc->normal);
    }
  }
}

bool CellSplitting::coversCore(const NoiseDisc& disc, const TrialCell& core) {
  double smallest;
  descent_.reset();
  return isEmptyCore(core, smallest) || coversCore(disc, core, smallest);
}

void CellSplitting::beginCore(const TrialCell& core, std::vector<TrialCell>& cells) {
  double smallest;
  if (isEmptyCore(core, smallest)) {
    return;
  }
  descent_.reset();
  if (coreExtentOf(core, smallest).reach <= kFirstReach * smallest) {
    cells.push_back(core);
    return;
  }
  const SurfacePatches::SplitCore split = descentOf(core, smallest).firstSplit();
  beginSplit(split, smallest, cells);
}

void CellSplitting::beginSplit(const SurfacePatches::SplitCore& split, double smallest,
                               std::vector<TrialCell>& cells) {
  TrialCell cell;
  for (int quarter = 0; quarter < 3; ++quarter) {
    cell.piece = split.pieces[quarter];
    begin({&cell, 1}, BoundedPatch(split.patches[quarter]), cells);
  }
  cell.piece = split.core;
  const double reach = farthestDistance(surface_.patches.coreVertex(split.core), split.core_box);
  if (reach > kFirstReach * smallest) {
    beginCore(cell, cells);
  } else if (2 * reach > surface_.gap * smallest) {
    cells.push_back(cell);
  }
}

bool CellSplitting::coversCore(const NoiseDisc& disc, const TrialCell& core, double smallest) {
  const CoreExtent& extent = coreExtentOf(core, smallest);
  return isCloser(disc, extent.middle, extent.reach, smallest) &&
         (extent.cone.isFacedBy(disc.normal) || descentOf(core, smallest).facesAll(disc.normal));
}

CoreDescent& CellSplitting::descentOf(const TrialCell& core, double smallest) {
  if (!descent_) {
    descent_.emplace(surface_.patches, surface_.settling, core.piece, surface_.gap * smallest);
  }
  return *descent_;
}

const CoreExtent& CellSplitting::coreExtentOf(const TrialCell& core, double smallest) {
  CoreExtent& extent = surface_.cores[static_cast<std::size_t>(core.piece.tile)];
  if (extent.steps != core.piece.steps) {
    CoreDescent& descent = descentOf(core, smallest);
    // The cone of a larger core serves the smaller ones in it as well.
    if (!extent.cone.isKnown()) {
      extent.cone = descent.cone();
    }
    descent.findReach();
    extent.steps = core.piece.steps;
    extent.middle = descent.middle();
    extent.reach = descent.reach();
  }
  return extent;
}

}  // namespace limitsurf
