// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Bound on the distance of a point of a geodesic from where it should be, relative to the length
/// of the geodesic, where it stays on bicubic patches. The steps of the integration keep a local
/// error that is a hundred times smaller; how errors grow depends on the surface, so that the bound
/// is measured. A geodesic that runs within 2^-16 of a face from an extraordinary vertex is led
/// past it, to a place 2^-14 of a face beyond, which displaces it by less than that.
constexpr double kGeodesicError = 1e-6;

/// Follows geodesics, the straightest curves, over a limit surface, across the borders of faces. At
/// an infinitely sharp edge a geodesic goes on at the same angle to the edge, as if the faces lay
/// in a plane. Along a fold of the surface, where it has no tangent plane, a geodesic ends; its
/// cost is bounded there too.
///
/// The geodesic equation is integrated by the method of Dormand & Prince on each bicubic patch. The
/// tracer is made for one pose of the surface, to which it refers. All const members may be called
/// from many threads at once.
///
/// Cost of making it: O(faces log faces), 0.1 s for 100,000. A geodesic takes some microseconds on
/// each face.
class GeodesicTracer {
 public:
  explicit GeodesicTracer(const LimitSurface& surface, int threads = 0);
  ~GeodesicTracer();
  GeodesicTracer(GeodesicTracer&&) noexcept;
  GeodesicTracer& operator=(GeodesicTracer&&) noexcept;

  struct Stop {
    Location at;
    Vector3 position;
    Vector3 direction, normal;  ///< unit; the direction is perpendicular to the normal
  };
  struct Path {
    std::vector<Stop> stops;  ///< as many as were reached
    double length;            ///< how far it ran
    bool hit = false;         ///< whether it ended at one of the edges given by `targets`
  };
  /// Follows the geodesic from a location in a direction (whose part along the normal does not
  /// count) until the last one of the lengths, which grow. It ends where the surface ends, at
  /// non-manifold edges and, if `targets` is given, at the first edge for which it holds true, or
  /// at an extraordinary vertex of such an edge: the edges are numbered in the order in which the
  /// faces use them first.
  Path trace(const Location& from, const Vector3& direction, const std::vector<double>& lengths,
             const std::vector<bool>* targets = nullptr) const;

  /// The numbers of edges, given by their vertices, for `targets`. Edges that the mesh does not
  /// have are left out.
  std::vector<bool> targets(const std::vector<std::pair<int, int>>& edges) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
