// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Means of the curvature around irregular vertices, where curvature itself has no limit.
/// LimitSurface::curvature() defines them.
class IrregularCurvature {
 public:
  /// The number of places on each face. A square with the vertex at one corner has two sides that
  /// do not touch the vertex; the places are the middles of the equal pieces of these sides.
  static constexpr int kPlacesPerFace = 4;

  /// `radius` is the side of that square, as a share of an edge. Cost: O(Ptex faces).
  IrregularCurvature(const TileTable& table, const Pose& pose, const PtexFaces& ptex,
                     double radius);

  /// The means around the vertices of these rings of the table. Cost: O(valence) for each of a
  /// ring's faces.
  std::vector<PrincipalCurvatures> around(const std::vector<int>& rings, int threads) const;

 private:
  /// A corner of a Ptex face.
  struct PtexCorner {
    int face = -1, corner = 0;
  };

  /// What a place contributes to the mean.
  struct Place {
    PrincipalCurvatures curvature;
    double area;   ///< |du x dv|, over the square of `scale`
    double scale;  ///< the largest component of du and dv, counted in edges
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
  std::vector<PtexCorner> corners_;  // per ring tile
  std::vector<int> first_tile_;      // per ring, and one more entry
};

}  // namespace limitsurf
