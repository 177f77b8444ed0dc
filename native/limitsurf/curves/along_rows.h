// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/curve_samples.h"
#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/curves/geodesic_tracer.h"
#include "limitsurf/curves/point_grid.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Finds places at a distance from curves, by geodesics that leave these perpendicularly, and ends
/// rows where another part of the curves is nearer. Made for one pose.
class AlongRows {
 public:
  /// `step` is the distance between rows, `most` that of the last one.
  AlongRows(const LimitSurface& surface, const EdgeCurves& curves, double step, double most,
            int threads);

  /// The place at a distance from a point of the curves, whose geodesic begins in the direction
  /// `inward`. Returns false where the surface ends before, or where a part of the curves is nearer
  /// than the distance by more than half of kRowError.
  bool place(const Location& foot, const Vector3& inward, double distance,
             GeodesicTracer::Stop& out) const;

 private:
  bool isNearer(const GeodesicTracer::Stop& at, double distance) const;
  bool reachesVertex(const GeodesicTracer::Stop& at, int sample, double most) const;
  bool hasVertex(const Location& at, int vertex) const;

  const LimitSurface& surface_;
  GeodesicTracer tracer_;
  std::vector<bool> targets_;
  double spacing_;
  CurveSamples samples_;
  PointGrid grid_;
};

}  // namespace limitsurf
