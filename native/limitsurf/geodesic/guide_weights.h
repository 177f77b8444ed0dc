// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/geodesic/cut_edges.h"
#include "limitsurf/progress.h"
#include "limitsurf/search/polylines.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Bound on the error of the distances of guide_weights, on smooth surfaces: relative to the
/// distance, where that is at least an eighth of a face's side. On flat surfaces the error is below
/// 5e-3 of such a side, as far as no cut or border stands in the way. A few distances may be off by
/// up to 4 %: those around the end of a cut that is within a face of both ends of the way; one in a
/// thousand around poles, where guides are much closer to each other than the triangles are long;
/// and one in 2,500 where there are more than five guides on each face, where as many guides are
/// missed though they are among the nearest.
constexpr double kGuideDistanceError = 0.01;

/// The nearest guides of places on a surface, `count` in each row, the nearest first. Where there
/// are fewer guides that can be reached, the guide is -1, the weight 0 and the distance infinite.
struct GuideWeights {
  int count = 0;
  std::vector<std::int32_t> guide;
  std::vector<double> weight;  ///< the weights of a row add up to 1
  std::vector<double> distance;
};

struct GuideOptions {
  static constexpr int kMostGuides = 16;

  int count = 4;  ///< guides of each place, 1 to kMostGuides
  /// Edges of the control mesh that no way crosses. A way may go around the end of a row of edges.
  EdgeList cuts{};
  /// Curves on the surface or near it that no way crosses. They are laid onto the surface at the
  /// points of it that are closest to them. A way may go around an end, unless it lies on a border
  /// or on another curve.
  Polylines cut_curves{};
  int threads = 0;
  Progress progress{};
};

/// Finds the nearest guides of each place by their distance along the surface, and weights that
/// fall off with it: ((1 - d / R) / d)^2 for the distance d, where R is the distance of the next
/// guide that has no weight, and scaled so that they add up to 1 (Franke, Nielson: "Smooth
/// interpolation of large sets of scattered data", 1980). So the weights of a guide go to 0 where
/// another takes its place, and a place at a guide has the shape of this guide alone.
///
/// Distances are measured on triangles with their vertices on the limit surface, which are smaller
/// near guides and cuts, and where guides are close together: kGuideDistanceError. A guide can be
/// missed only if it is farther away than a guide that is found, or by less than the size of a
/// triangle nearer than it.
///
/// Properties: any number of threads gives the same bits; a row does not depend on the others.
///
/// Throws std::invalid_argument for a count out of range, for offsets of curves that are not those
/// of Polylines, naming the first point of them that is not finite, and for curves of more than 30
/// million pieces as long as half a triangle's side; MeshError for cuts that are
/// no edges, and as evaluate() does for locations. Cost: about 1 microsecond for each vertex of
/// the triangles and each guide that it keeps (five more than `count`, and more where triangles
/// are long), on one core; a microsecond a place, on all cores. The triangles have 16,000 to 64,000
/// vertices, or on meshes of more than 4,000 faces four for each face and sixteen for each face
/// near a guide. Memory: 24 bytes for each vertex and each guide that it keeps, and 16 for each
/// guide of a place.
GuideWeights guideWeights(const LimitSurface& surface, const LocationBatch& guides,
                          const LocationBatch& at, const GuideOptions& options = {});

/// Writes the weights of `count` guides at these distances, the nearest first. `end` is the
/// distance at which weights end: that of the first guide without a weight, or infinity if there is
/// none.
void weightsByDistance(const double* distances, int count, double end, double* weights);

}  // namespace limitsurf
