// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// A level for each face of a mesh, and what was measured to find it.
struct FaceLevels {
  std::vector<int> levels;  ///< 0 for faces without a surface
  /// The deviation or length of the face's polygons, NaN for faces without a surface. It is
  /// measured at the level that the face itself needs: where a neighbour raised the level, `levels`
  /// is higher.
  Eigen::VectorXd measure;
};

struct LevelOptions {
  int most = 8;  ///< the largest level
  int threads = 0;
  Progress progress{};
};

/// The levels of faces that meet at an edge differ by at most this; a smaller one is raised.
constexpr int kLargestLevelStep = 2;

/// The lowest levels at which polygons are within `tolerance` of the surface, by measurement.
/// Deviations are measured along the surface's normal, between the surface and each of the two
/// pairs of triangles that a quad can be cut into, at kDeviationSamples or more places along each
/// side of a Ptex face, and at the middles of sides, diagonals and quads of all polygons. Along
/// edges that are a boundary or infinitely sharp the distance from the side is measured as well.
/// Between these places deviations may be larger: they are not bounded.
///
/// `measure` is the largest deviation; it exceeds `tolerance` where `most` levels are too few.
/// Throws std::invalid_argument unless tolerance is finite and above 0, and 1 <= most <= 12. Cost:
/// four to six evaluations for each point of the tessellation.
constexpr int kDeviationSamples = 8;
FaceLevels levelsWithin(const LimitSurface& surface, double tolerance,
                        const LevelOptions& options = {});

/// The view of a picture: `matrix` takes points to homogeneous coordinates, and lengths are
/// measured in x / w and y / w. Points with w < nearest are not visible.
struct PictureView {
  Eigen::Matrix4d matrix;
  double nearest = 0;
};

/// The lowest levels at which the sides of polygons are no longer than `length`, in space or in the
/// picture of `view`. Lengths are measured along the surface, from place to place at 1/8, 2/8, ...
/// of each side of a Ptex face: the sides of up to 8 quads are sums of these, further ones equal
/// parts. Where a side has more quads than that, those at its corners are measured as well.
/// `measure` is the longest. Between these places sides may be longer: they are not bounded. A face
/// that is not visible has no length, and the lowest level.
///
/// Throws std::invalid_argument unless length is finite and above 0, 1 <= most <= 12, and all
/// numbers of the view are finite.
FaceLevels levelsOfLength(const LimitSurface& surface, double length,
                          const PictureView* view = nullptr, const LevelOptions& options = {});

}  // namespace limitsurf
