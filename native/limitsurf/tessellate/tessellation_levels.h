// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// A level for each face of a mesh, and what was measured of the face's polygons at that level, or
/// at a lower one if it was raised for a neighbour's sake. 0 and NaN for faces without a surface.
struct FaceLevels {
  std::vector<int> levels;
  Eigen::VectorXd measure;
};

struct LevelOptions {
  int most = 8;  ///< levels above this are not tried
  int threads = 0;
  Progress progress{};
};

/// Levels of faces that meet at an edge differ by no more than this: the larger one counts.
constexpr int kLargestLevelStep = 2;

/// The lowest levels at which polygons are within `tolerance` of the surface, as far as is
/// measured: at kDeviationSamples or more places along each side of a Ptex face, and at the middles
/// of sides, diagonals and quads of all polygons, between the surface and each of the two pairs of
/// triangles that a quad can be cut into, along the surface's normal; along edges that are a border
/// or infinitely sharp the distance from the side as well. Between those places deviations may be
/// larger: they are not bounded.
///
/// `measure` is the largest deviation; it is above `tolerance` where `most` levels are too few.
/// Throws std::invalid_argument unless tolerance > 0, finite, and 1 <= most <= 12. Cost: four to
/// six evaluations a point of the tessellation.
constexpr int kDeviationSamples = 8;
FaceLevels levelsWithin(const LimitSurface& surface, double tolerance,
                        const LevelOptions& options = {});

/// What takes points to a picture: `matrix` gives homogeneous coordinates, of which x / w and y / w
/// are measured. What has w < nearest is not seen.
struct PictureView {
  Eigen::Matrix4d matrix;
  double nearest = 0;
};

/// The lowest levels at which polygons' sides are no longer than `length`: in space, or in the
/// picture of `view`. Measured between places at 1/8, 2/8, ... of each side of a Ptex face;
/// `measure` is the longest. What is not seen has no length, and the lowest level.
///
/// Throws std::invalid_argument unless length > 0, finite, 1 <= most <= 12, and all numbers of the
/// view are finite.
FaceLevels levelsOfLength(const LimitSurface& surface, double length,
                          const PictureView* view = nullptr, const LevelOptions& options = {});

}  // namespace limitsurf
