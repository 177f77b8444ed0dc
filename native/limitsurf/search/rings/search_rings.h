// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limitsurf/first_made.h"
#include "limitsurf/search/rings/ring_bounds.h"
#include "limitsurf/search/rings/sector_tree.h"

namespace limitsurf {

/// What is known of the surface around a vertex from one level on.
struct RingLevel {
  RingBounds bounds;  ///< between the level's cores and those of the next
  /// A box around the next level's cores in the frame of the bounds.
  Vector3 rest_low = Vector3::Zero(), rest_high = Vector3::Zero();

  /// A lower bound of the squared distance of the next level's cores from a point, which the frame
  /// has at `q`, less that of the vertex from it.
  double restSquaredDistanceLess(const Vector3& q) const;
};

/// What searches know of the cores around each extraordinary vertex as a whole. All of it is made
/// when it is first asked for, and all members may be called from many threads at once.
class SearchRings {
 public:
  /// Around vertices with more cores, all cores are searched together. Steep rays onto poles of 8
  /// to 16 faces then take two fifths of the time, and closest points near them three fifths.
  /// Vertices of 6 and 7 faces, which triangle meshes are full of, gain a seventh at most, and it
  /// would take longer until the first answer.
  static constexpr int kFewCores = 7;

  /// `tolerance` is the error that a search may leave. Refers to the patches.
  SearchRings(const SurfacePatches& patches, double tolerance);
  ~SearchRings();

  /// Whether the cores around the vertex are searched together.
  bool isLarge(int ring) const { return coreCount(ring) > kFewCores; }
  int coreCount(int ring) const { return first_[ring + 1] - first_[ring]; }
  /// The first level at which all tiles around the vertex have cores.
  int firstLevel(int ring) const { return first_levels_[ring]; }
  /// The tile of the first core.
  int firstTile(int ring) const { return cores_[first_[ring]].tile; }
  /// A core at a level from the first one on; cores are in the order of the ring's faces.
  SurfacePiece core(int ring, int place, int level) const;
  std::vector<SurfacePiece> cores(int ring, int level) const;

  /// Bounds of the surface at a level from the first one on.
  const RingLevel& level(int ring, int level) const;
  /// The patches between the cores of a level and those of the next.
  const SectorTree& sectors(int ring, int level) const;

  /// Takes the steps of a core that `isSkipped(level)`, until `isSmall(core)`. Only a core that has
  /// come far asks what is known of its vertex, and few do.
  template <typename IsSmall, typename IsSkipped>
  void skipLevels(SurfacePiece& core, const IsSmall& isSmall, const IsSkipped& isSkipped) const {
    const int ring = patches_.ringOf(core);
    if (core.steps < kManySteps || patches_.ringLevel(core) < firstLevel(ring)) {
      return;
    }
    while (!isSmall(core) && isSkipped(level(ring, patches_.ringLevel(core)))) {
      ++core.steps;
    }
  }

  /// Whether the surface around the vertex has the symmetry of a regular polygon, so that the
  /// distances of all cores, at the first level and later ones, from a point on the axis differ by
  /// less than the tolerance, and also from points that are as far from the axis as `aside`.
  bool isSymmetric(int ring, double aside) const;

 private:
  static constexpr int kManySteps = 8;

  struct Kept;
  const Kept& kept(int ring) const;

  const SurfacePatches& patches_;
  const double tolerance_;
  std::vector<int> first_;           ///< for each ring, where its tiles begin
  std::vector<SurfacePiece> cores_;  ///< at the first level
  std::vector<int> first_levels_;
  std::unique_ptr<FirstMade<Kept>[]> kept_;
};

}  // namespace limitsurf
