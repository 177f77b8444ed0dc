// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

/// Throws std::invalid_argument unless the tolerance is a finite number above 0.
void checkTolerance(double tolerance);

/// The closest points of the surface. Throws MeshError where the surface has no point at all.
Hits feet(const SurfaceSearch& search, const Points& points, int threads);
Hits feet(const SurfaceSearch& search, const std::vector<Vector3>& points, int threads);

/// A straight segment between two points.
struct Segment {
  Vector3 from, to;
};

/// The distance of a point from the segment between two others.
double distanceFromSegment(const Vector3& from, const Vector3& to, const Vector3& point);

/// The largest distance from the surface on each segment: among kDistanceProbes evenly spaced
/// places inside of the segment, and then between the neighbours of the farthest of them, where a
/// golden section search of kGoldenSteps steps refines it. It is a distance that occurs, so a lower
/// bound of the true maximum; where the distance along the segment is a bump with one maximum it is
/// that maximum to 1 %. What is narrower than a sixteenth of the segment can be missed.
std::vector<double> largestDistances(const SurfaceSearch& search,
                                     const std::vector<Segment>& segments, int threads);

constexpr int kDistanceProbes = 15;
/// The share of the tolerance that a segment may take before its distance is measured closely: it
/// leaves room for what lies between three probes.
constexpr double kAccepted = 0.75;
/// Relative to the size of coordinates: searches find no smaller distance from the surface.
constexpr double kLeastDistance = 1e-12;
constexpr int kGoldenSteps = 6;

}  // namespace limitsurf
