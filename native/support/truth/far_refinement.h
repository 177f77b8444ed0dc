// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/primvarRefiner.h>

#include <memory>
#include <vector>

#include "support/cages/cage.h"
#include "support/truth/channels.h"

namespace limitsurf::test {

struct FarPrimvar {
  Eigen::RowVector3d value = Eigen::RowVector3d::Zero();

  void Clear() { value.setZero(); }
  void AddWithWeight(const FarPrimvar& other, double weight) { value += weight * other.value; }
};

/// The square that a refined face covers of its Ptex face.
struct FarSquare {
  int face;
  double u, v, size;
};

/// A cage that OpenSubdiv has refined uniformly, in double.
struct FarRefinement {
  FarRefinement(const Cage& cage, int level, const Channel& channel = {},
                Interpolation interpolation = Interpolation::all);

  std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
  std::vector<FarPrimvar> points;
  std::vector<FarSquare> squares;  ///< of the last level's faces
};

/// A face-varying channel that OpenSubdiv has refined with its cage, in double: the channel of
/// subdivided(cage, level), with values that have the same limit.
struct RefinedChannel {
  Channel channel;
  DataRows values;
};
RefinedChannel subdivided(const Cage& cage, int level, const Channel& channel,
                          const DataRows& values, Interpolation interpolation);

/// The refined mesh as a cage of its own, with what is left of the sharpness: it has the same limit
/// surface.
Cage subdivided(const Cage& cage, int level);

}  // namespace limitsurf::test
