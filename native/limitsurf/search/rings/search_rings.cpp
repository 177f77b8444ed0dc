// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rings/search_rings.h"

#include <algorithm>
#include <array>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// Levels are looked at so many at a time: the cores of the next one are at hand then.
constexpr int kTogether = 8;
constexpr int kGroups = SurfacePatches::kMostSteps / kTogether + 1;

}  // namespace

double RingLevel::restSquaredDistanceLess(const Vector3& q) const {
  const Vector3 nearest = q.cwiseMax(rest_low).cwiseMin(rest_high);
  const double reach = rest_low.cwiseAbs().cwiseMax(rest_high.cwiseAbs()).norm();
  return nearest.dot(nearest - 2 * q) - differenceRounding(reach, q.norm());
}

struct SearchRings::Kept {
  struct Number {
    double value;
  };
  std::array<FirstMade<std::array<RingLevel, kTogether>>, kGroups> levels;
  FirstMade<Number> asymmetry;
  std::array<FirstMade<SectorTree>, SurfacePatches::kMostSteps + 1> sectors;
};

SearchRings::SearchRings(const SurfacePatches& patches, double tolerance)
    : patches_(patches),
      tolerance_(tolerance),
      first_(static_cast<std::size_t>(patches.ringCount()) + 1, 0),
      first_levels_(static_cast<std::size_t>(patches.ringCount()), 0),
      kept_(new FirstMade<Kept>[static_cast<std::size_t>(patches.ringCount())]) {
  std::vector<SurfacePiece> pieces;
  std::vector<SurfacePiece> found;
  InterruptionStride stride;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    stride.step();
    pieces.clear();
    patches.appendPieces(tile, pieces);
    if (pieces[0].isCore()) {
      const int ring = patches.ringOf(pieces[0]);
      ++first_[ring + 1];
      first_levels_[ring] = std::max(first_levels_[ring], patches.ringLevel(pieces[0]));
      found.push_back(pieces[0]);
    }
  }
  for (std::size_t ring = 1; ring < first_.size(); ++ring) {
    first_[ring] += first_[ring - 1];
  }
  cores_.resize(found.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (SurfacePiece core : found) {
    stride.step();
    const int ring = patches.ringOf(core);
    core.steps = static_cast<std::int16_t>(first_levels_[ring] - patches.ringLevel(core));
    cores_[next[ring]++] = core;
  }
  for (int ring = 0; ring < patches.ringCount(); ++ring) {
    stride.step();
    std::sort(cores_.begin() + first_[ring], cores_.begin() + first_[ring + 1],
              [&](const SurfacePiece& a, const SurfacePiece& b) {
                return patches.ringFace(a) < patches.ringFace(b);
              });
  }
}

SearchRings::~SearchRings() = default;

const SearchRings::Kept& SearchRings::kept(int ring) const {
  return kept_[ring].get([] { return std::make_unique<const Kept>(); });
}

SurfacePiece SearchRings::core(int ring, int place, int level) const {
  SurfacePiece core = cores_[first_[ring] + place];
  core.steps = static_cast<std::int16_t>(core.steps + level - first_levels_[ring]);
  return core;
}

std::vector<SurfacePiece> SearchRings::cores(int ring, int level) const {
  std::vector<SurfacePiece> cores;
  for (int i = 0; i < coreCount(ring); ++i) {
    cores.push_back(core(ring, i, level));
  }
  return cores;
}

const RingLevel& SearchRings::level(int ring, int level) const {
  const int group = (level - firstLevel(ring)) / kTogether;
  const auto& levels = kept(ring).levels[static_cast<std::size_t>(group)].get([&] {
    const Eigen::Matrix3d frame = patches_.ringFrame(ring);
    auto made = std::make_unique<std::array<RingLevel, kTogether>>();
    SurfacePatches::SplitCore split;
    InterruptionStride stride;
    for (int place = 0; place < coreCount(ring); ++place) {
      SurfacePiece piece = core(ring, place, firstLevel(ring) + group * kTogether);
      const Vector3 vertex = patches_.coreVertex(piece);
      for (RingLevel& next : *made) {
        if (piece.steps >= SurfacePatches::kMostSteps) {
          break;
        }
        stride.step();
        patches_.split(piece, split);
        for (const BezierPatch& patch : split.patches) {
          next.bounds.include(patch, vertex, frame);
        }
        const CoreHull hull = patches_.restHull(split);
        next.rest_low = next.rest_low.cwiseMin(hull.low);
        next.rest_high = next.rest_high.cwiseMax(hull.high);
        piece = split.core;
      }
    }
    return std::unique_ptr<const std::array<RingLevel, kTogether>>(std::move(made));
  });
  return levels[static_cast<std::size_t>(level - firstLevel(ring) - group * kTogether)];
}

const SectorTree& SearchRings::sectors(int ring, int level) const {
  return kept(ring).sectors[static_cast<std::size_t>(level)].get(
      [&] { return std::make_unique<const SectorTree>(patches_, cores(ring, level)); });
}

bool SearchRings::isSymmetric(int ring, double aside) const {
  // Turned around the axis, so that one core comes to lie where another was, the point moves by
  // twice its distance from the axis at most.
  if (2 * aside >= tolerance_) {
    return false;
  }
  const double apart =
      kept(ring)
          .asymmetry
          .get([&] {
            return std::make_unique<const Kept::Number>(
                Kept::Number{patches_.ringAsymmetry(cores(ring, firstLevel(ring)), tolerance_)});
          })
          .value;
  return 2 * aside + apart < tolerance_;
}

}  // namespace limitsurf
