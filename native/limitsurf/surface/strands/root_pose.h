// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/direction_maps.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/pose.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Where the root of a strand lies, and the frame there: columns tangent, normal x tangent, normal.
struct RootPose {
  Padded position;
  Padded frame[3];
};

/// Finds the roots of strands on a surface, carried by an affine map. Each thread needs one of its
/// own.
class RootFinder {
 public:
  /// `directions` are those of the map. Keeps references to all arguments but the map.
  RootFinder(const TileTable& table, const Pose& pose, const Eigen::Matrix4d& map,
             const DirectionMaps& directions)
      : table_(table), pose_(pose), evaluator_(table, pose), directions_(directions) {
    for (int column = 0; column < 4; ++column) {
      map_[column] = Padded(map(0, column), map(1, column), map(2, column), 0);
    }
  }

  RootPose operator()(const TileLocation& at);

 private:
  /// If the sine of the angle between du and dv is larger, their cross product keeps all digits
  /// that kNormalError needs.
  static constexpr double kSafeSine = 0x1p-7;
  /// Squares of lengths between these bounds neither overflow nor lose digits.
  static constexpr double kSmallSquare = 1e-140, kLargeSquare = 1e140;

  Padded carried(const Padded& vector) const {
    return vector[0] * map_[0] + vector[1] * map_[1] + vector[2] * map_[2];
  }
  /// The carried frame where du and dv alone do not give it.
  void setFrame(const TileLocation& at, const Jet& jet, Padded frame[3]);

  const TileTable& table_;
  const Pose& pose_;
  TileEvaluator evaluator_;
  Padded map_[4];  // the columns
  /// Its side is that of the carried normal, seen along the cross product of the carried du and dv.
  const DirectionMaps& directions_;
};

}  // namespace limitsurf
