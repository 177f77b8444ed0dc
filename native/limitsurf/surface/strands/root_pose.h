// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/direction_maps.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/batch/normal_limits.h"
#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Where the root of a strand lies, and the frame there: columns tangent, normal x tangent, normal.
struct RootPose {
  Padded position;
  Padded frame[3];
};

/// An affine map from a surface's space to that of the strands, which carries roots.
class RootMap {
 public:
  explicit RootMap(const Eigen::Matrix4d& map);

  /// Carries a root whose frame its derivatives alone give. Where they don't, because they are too
  /// short, too close to parallel or below `limits`, returns false: `root.position` is set then.
  bool carry(const Padded& position, const Padded& du, const Padded& dv, const NormalLimits& limits,
             RootPose& root) const;
  /// Sets the frame to what the map makes of a frame on the surface.
  void carryFrame(const Eigen::Matrix3d& on_surface, Padded frame[3]) const;

 private:
  Padded carried(const Padded& vector) const {
    return vector[0] * map_[0] + vector[1] * map_[1] + vector[2] * map_[2];
  }

  Padded map_[4];  // the columns
  /// Its side is that of the carried normal, seen along the cross product of the carried du and dv.
  DirectionMaps directions_;
};

/// Finds the roots of strands on a surface in its pose. Each thread needs one of its own.
class RootFinder {
 public:
  /// Keeps references to all arguments.
  RootFinder(const TileTable& table, const Pose& pose, const RootMap& map)
      : table_(table), pose_(pose), evaluator_(table, pose), map_(map) {}

  RootPose operator()(const TileLocation& at);

 private:
  const TileTable& table_;
  const Pose& pose_;
  TileEvaluator evaluator_;
  const RootMap& map_;
};

}  // namespace limitsurf
