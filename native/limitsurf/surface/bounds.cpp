// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include "limitsurf/bernstein.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {
namespace {

/// The largest value of each coordinate and of its negative that has been found.
struct Extremes {
  std::array<double, 6> most;

  Extremes() { most.fill(-std::numeric_limits<double>::infinity()); }

  void include(const Vector3& point) {
    for (int i = 0; i < 3; ++i) {
      most[i] = std::max(most[i], point[i]);
      most[3 + i] = std::max(most[3 + i], -point[i]);
    }
  }

  /// Whether nothing in the box is larger by more than `tolerance`.
  bool cover(const Box& box, double tolerance) const {
    for (int i = 0; i < 3; ++i) {
      if (box.high[i] > most[i] + tolerance || -box.low[i] > most[3 + i] + tolerance) {
        return false;
      }
    }
    return true;
  }
};

/// A square is halved so often at most: its sides are then at the limit of double precision. (The
/// tolerance ends the search earlier, unless all coefficients are equal but for rounding.)
constexpr int kMostHalvings = 60;

/// Tiles that are searched one after the other. The result depends on it in its last bits, so that
/// it must not depend on the number of threads.
constexpr std::size_t kTilesPerBlock = 1024;

/// Raises `most` to the polynomial's maximum if that is larger by more than `tolerance` (branch and
/// bound).
void raise(const Bernstein<3>& f, double tolerance, int halvings, double& most) {
  most = std::max({most, f.at(0, 0), f.at(3, 0), f.at(0, 3), f.at(3, 3)});
  if (f.largest() <= most + tolerance || halvings == 0) {
    return;
  }
  Bernstein<3> quarters[4];
  f.quarter(quarters);
  for (const Bernstein<3>& quarter : quarters) {
    raise(quarter, tolerance, halvings - 1, most);
  }
}

void include(const BezierPatch& patch, double tolerance, Extremes& extremes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {1, -1}) {
      Bernstein<3> f;
      for (int i = 0; i < 16; ++i) {
        f.at(i & 3, i >> 2) = sign * (patch.anchor[axis] + patch.points[i][axis]);
      }
      raise(f, tolerance, kMostHalvings, extremes.most[sign > 0 ? axis : 3 + axis]);
    }
  }
}

/// Includes patch after patch towards a core's vertex, until the rest of the core cannot change the
/// result any more.
void includeCore(const SurfacePatches& patches, SurfacePiece core, double tolerance,
                 Extremes& extremes) {
  extremes.include(patches.coreVertex(core));
  if (extremes.cover(patches.coreBox(core), tolerance)) {
    return;
  }
  SurfacePatches::SplitCore split;
  while (core.steps < SurfacePatches::kMostSteps) {
    patches.split(core, split);
    for (const BezierPatch& patch : split.patches) {
      include(patch, tolerance, extremes);
    }
    if (extremes.cover(split.core_box, tolerance)) {
      return;
    }
    core = split.core;
  }
}

}  // namespace

Eigen::Matrix<double, 2, 3, Eigen::RowMajor> LimitSurface::bounds(int threads) const {
  checkThreads(threads);
  const SurfacePatches patches(*this, threads);
  const double tolerance = kPositionError / 4 * patches.diagonal();

  // A first guess excludes most tiles. Each block continues from this guess alone, so that the
  // result does not depend on the order in which blocks are searched.
  Extremes guess;
  for (const Location& at : vertexLocations()) {
    if (at.face >= 0) {
      TileEvaluator evaluator(data_->table, data_->pose);
      Jet jet;
      evaluator.evaluate<0>(evaluator.locate(at), jet);
      guess.include((jet.anchor + jet.patch.value).head<3>().matrix());
    }
  }
  const std::size_t tiles = static_cast<std::size_t>(patches.tileCount());
  std::vector<Extremes> blocks((tiles + kTilesPerBlock - 1) / kTilesPerBlock, guess);
  parallelFor(blocks.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      std::vector<SurfacePiece> pieces;
      for (std::size_t i = block * kTilesPerBlock;
           i < std::min(tiles, (block + 1) * kTilesPerBlock); ++i) {
        patches.appendPieces(static_cast<int>(i), pieces);
      }
      for (const SurfacePiece& piece : pieces) {
        if (piece.isCore()) {
          includeCore(patches, piece, tolerance, blocks[block]);
        } else {
          include(patches.patch(piece), tolerance, blocks[block]);
        }
      }
    }
  });
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> box;
  if (tiles == 0) {
    box.setConstant(std::numeric_limits<double>::quiet_NaN());
    return box;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const Extremes& block : blocks) {
      guess.most[axis] = std::max(guess.most[axis], block.most[axis]);
      guess.most[3 + axis] = std::max(guess.most[3 + axis], block.most[3 + axis]);
    }
    box(0, axis) = -guess.most[3 + axis];
    box(1, axis) = guess.most[axis];
  }
  return box;
}

}  // namespace limitsurf
