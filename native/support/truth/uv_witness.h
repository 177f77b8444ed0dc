// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "limitsurf/surface/surface_data.h"
#include "support/cages/cage.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/channels.h"

namespace limitsurf::test {

/// A named UV map of a cage.
struct NamedMap {
  std::string name;
  LimitSurface surface;
  SurfaceData map;
};

/// Maps with everything that makes inversion hard, within about [0, 1]^2: all interpolations, one
/// island and many, irregular vertices, poles, creases and polygons; plain, mirrored and
/// overlapping maps, and maps of random values that fold everywhere.
std::vector<NamedMap> uvMaps();

/// The places over a point of the plane.
struct Sheets {
  int count = 0;
  int lowest_face = -1;
  int of_lowest_face = 0;
  bool flipped = false;  ///< one of the lowest face
};

/// A map as a great many triangles: per_side x per_side evaluated squares on each Ptex face. It is
/// independent of the inversion.
class UvWitness {
 public:
  UvWitness(const LimitSurface& surface, const SurfaceData& map, int per_side);

  /// The places over each point; `known` is false where points at a distance of `deviation()` lie
  /// on other sheets.
  struct Answer {
    bool known;
    Sheets sheets;
  };
  std::vector<Answer> at(const DataRows& points) const;

  /// The distance of the triangles from the map.
  double deviation() const { return deviation_; }
  /// The distance to the nearest vertex of the triangles, with coordinates multiplied by `scale`.
  double distance(const Eigen::RowVector2d& point, const Eigen::RowVector2d& scale) const;

 private:
  std::vector<Sheets> sheetsAt(const DataRows& points) const;

  int per_side_;
  std::vector<int> faces_;
  DataRows values_;  // (per_side + 1)^2 of each face
  double deviation_ = 0;
};

}  // namespace limitsurf::test
