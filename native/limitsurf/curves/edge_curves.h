// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Bound on the relative error of the lengths of edges and curves. Each cubic is divided where its
/// speed is slowest, so that a cusp, which makes the integrand a kink, is the end of a part. Parts
/// are halved until Gauss-Legendre quadrature on 10 points agrees with that of the halves to 1e-11
/// of the length. A turn so narrow that all points overlook it, within 5e-6 of a part, changes the
/// length by 2e-10. The straight rests at extraordinary vertices add some 1e-12.
constexpr double kCurveLengthError = 1e-9;

/// Bound on the difference between the arc length that was asked for and that of the point that is
/// found, relative to the length of the curve, as both are measured by the same quadrature. Beside
/// the end of an edge at an extraordinary vertex places are rounded to 2^-53 of the edge, which can
/// be as much as 1e-9 of its length there.
constexpr double kArcInverseError = 1e-12;

/// Which edges of a control mesh are chosen.
enum class EdgeChoice {
  boundary,  ///< those of exactly one face
  creases,   ///< those of two faces with a sharpness above 0, those of three and more faces, and
             ///< those of faces of opposite winding
};

/// A side of a curve, as seen along it from outside.
enum class CurveSide { left, right };

/// Limit curves of chains of edges, measured by their true arc length.
///
/// An edge of the control mesh converges to a curve on the limit surface: a cubic on each bicubic
/// patch along it, and infinitely many of them at an extraordinary vertex. Chosen edges are linked
/// to chains: a curve goes on through vertices at which exactly two chosen edges meet, and ends at
/// all others. Edges whose faces all have no limit surface are left out.
///
/// Curves are in the order of their first edges, as faces use these. A curve runs in the direction
/// in which the first face of its first edge runs around, so that this face is on its left, and a
/// closed curve begins with that edge: curves of boundaries have the surface on their left.
///
/// The curves are those of the surface's pose when they were made; they do not refer to the surface
/// afterwards. All const members may be called from many threads at once.
///
/// Cost of making them: O(faces log faces) for the topology, and a microsecond for each cubic.
/// Memory: some 250 bytes for each regular edge, 10 KB for each end of an edge at an extraordinary
/// vertex.
class EdgeCurves {
 public:
  EdgeCurves(const LimitSurface& surface, EdgeChoice choice, int threads = 0);
  /// The curves of edges given by their vertices, in any order; an edge that is given twice counts
  /// once. Throws MeshError for the first one that the mesh does not have.
  EdgeCurves(const LimitSurface& surface,
             const std::vector<std::pair<std::int64_t, std::int64_t>>& edges, int threads = 0);
  ~EdgeCurves();
  EdgeCurves(EdgeCurves&&) noexcept;
  EdgeCurves& operator=(EdgeCurves&&) noexcept;

  /// The number of curves.
  int count() const;
  /// The edges of curve i are those from offsets()[i] to offsets()[i + 1] - 1.
  const std::vector<std::int64_t>& offsets() const;
  bool closed(int curve) const;
  double length(int curve) const;
  /// The number of chosen edges that are left out, because they have no limit surface.
  std::int64_t leftOut() const;

  // Edges, in the order and the direction of their curves.
  std::int64_t edgeCount() const { return offsets().back(); }
  std::pair<int, int> edgeVertices(std::int64_t edge) const;
  /// The face of the control mesh on a side of an edge, or -1.
  int edgeFace(std::int64_t edge, CurveSide side) const;
  double edgeLength(std::int64_t edge) const;

  struct Point {
    Location at;
    CurveSide side;  ///< of the curve on which the location's face lies
    std::int64_t edge;
    double fraction;   ///< of the edge, along the curve
    Vector3 position;  ///< on the curve's cubic
    Vector3 tangent;   ///< unit, along the curve; 0 on a curve without length
  };
  /// The point at an arc length from the curve's start, between 0 and its length. The location is
  /// on the face on the given side, or on the other one where no face with a surface is there.
  /// Cost: O(log(edges)).
  Point at(int curve, double arc, CurveSide side = CurveSide::left) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
