// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/pose.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Means of the curvature around irregular vertices, where it has no limit itself: what
/// LimitSurface::curvature() promises of them.
class IrregularCurvature {
 public:
  /// Places on each face that a mean is taken of: the middles of so many equal pieces of the two
  /// sides of a square with the vertex at one corner that do not touch the vertex.
  static constexpr int kPlacesPerFace = 4;

  /// `radius` is the side of that square, as a share of an edge. Cost: O(Ptex faces).
  IrregularCurvature(const TileTable& table, const Pose& pose, const PtexFaces& ptex,
                     double radius);

  /// One for each of these rings of the table. Cost: O(valence) for each of a ring's faces.
  std::vector<PrincipalCurvatures> around(const std::vector<int>& rings, int threads) const;

 private:
  /// A corner of a Ptex face.
  struct PtexCorner {
    int face = -1, corner = 0;
  };

  /// What a place adds to the mean.
  struct Place {
    PrincipalCurvatures curvature;
    double area;   ///< of the place's share of the surface, over the square of `scale`
    double scale;  ///< the larger of the lengths that `area` is the product of
  };

  int tileCount(int ring) const { return first_tile_[ring + 1] - first_tile_[ring]; }
  void findCorners();
  TileLocation locate(const TileEvaluator& evaluator, int ring_tile, double side, int number) const;
  Place place(TileEvaluator& evaluator, int ring_tile, int number) const;
  PrincipalCurvatures mean(int ring, const Place* places) const;
  Vector3 normalOf(int ring, const Place* places, const std::vector<double>& weights) const;

  const TileTable& table_;
  const Pose& pose_;
  const PtexFaces& ptex_;
  const double radius_;
  std::vector<PtexCorner> corners_;  // of the ring tiles
  std::vector<int> first_tile_;      // of each ring, and one more
};

}  // namespace limitsurf
