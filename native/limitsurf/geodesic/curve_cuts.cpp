// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/curve_cuts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/geodesic/triangle_cells.h"
#include "limitsurf/geodesic/triangle_cutter.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/search/line_pieces.h"
#include "limitsurf/search/surface_search.h"

namespace limitsurf {
namespace {

/// Samples of a curve on the length of a triangle's side.
constexpr double kSamplesPerSide = 2;
/// The shortest side that is assumed, as a share of the mean longest side. Triangles thinner than
/// its square, 1 : 64, would ask for thousands of samples each.
constexpr double kShortestSide = 1. / 8;
/// Points of a curve that are closer together, as a share of the distance of samples, are left out.
constexpr double kClosest = 0.1;
/// The distances in which places are taken for points and sides of triangles, as a share of a
/// triangle's height: of an end of a curve, and of all others.
constexpr double kReach = 1e-2, kSame = 1e-6;

/// Curves as rows of points. Curve i has the rows first[i] to first[i + 1] - 1.
struct Samples {
  std::vector<Vector3> points;
  std::vector<std::size_t> first = {0};
};

/// The power of two that brings the largest coordinate to between 1 and 2, so that products of
/// several lengths stay in range.
double ownUnit(const SurfaceTriangles& triangles) {
  double largest = 0;
  for (const Vector3& point : triangles.points) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
  }
  return scaleToOwnUnit(largest);
}

double typicalSide(const SurfaceTriangles& triangles) {
  double twice_area = 0, longest = 0;
  for (const auto& [a, b, c] : triangles.vertices) {
    const Vector3& origin = triangles.points[a];
    const Vector3 to_b = triangles.points[b] - origin, to_c = triangles.points[c] - origin;
    twice_area += to_b.cross(to_c).norm();
    longest += std::max({to_b.norm(), to_c.norm(), (to_c - to_b).norm()});
  }
  const double count = static_cast<double>(triangles.vertices.size());
  return std::max(std::sqrt(twice_area / count), kShortestSide * longest / count);
}

void sampleLine(const Vector3& from, const Vector3& to, double spacing,
                std::vector<Vector3>& points) {
  const auto pieces = static_cast<double>(piecesOfLine(from, to, spacing));
  InterruptionStride stride;
  for (int i = 1; i <= pieces; ++i) {
    stride.step();
    points.push_back(from + i / pieces * (to - from));
  }
}

Samples sample(const Polylines& curves, double unit, double spacing) {
  Samples samples;
  samples.points.reserve(
      static_cast<std::size_t>(countPieces(curves, spacing / unit, "cut_points")) +
      curves.offsets.size());
  InterruptionStride stride;
  for (std::size_t curve = 0; curve + 1 < curves.offsets.size(); ++curve) {
    stride.step();
    const std::int64_t begin = curves.offsets[curve], last = curves.offsets[curve + 1] - 1;
    if (last <= begin) {
      continue;
    }
    samples.points.emplace_back(unit * curves.points.row(begin));
    for (std::int64_t row = begin + 1; row <= last; ++row) {
      stride.step();
      const Vector3 to = unit * curves.points.row(row), from = samples.points.back();
      if (row == last || (to - from).norm() > kClosest * spacing) {
        sampleLine(from, to, spacing, samples.points);
      }
    }
    samples.first.push_back(samples.points.size());
  }
  return samples;
}

/// Cuts triangles whose points have been multiplied by the unit.
void cutInUnit(SurfaceTriangles& triangles, double unit, const LimitSurface& surface,
               const std::vector<int>& levels, const Polylines& curves, int threads) {
  const double side = triangles.vertices.empty() ? 0 : typicalSide(triangles);
  if (!(side > 0)) {
    return;
  }
  const Samples samples = sample(curves, unit, side / kSamplesPerSide);
  if (samples.points.empty()) {
    return;
  }
  Points points(static_cast<Eigen::Index>(samples.points.size()), 3);
  for (std::size_t row = 0; row < samples.points.size(); ++row) {
    points.row(static_cast<Eigen::Index>(row)) = samples.points[row] / unit;
  }
  const Hits hits = SurfaceSearch(surface, threads).closest(points, {}, threads);
  const TriangleCells cells(surface, levels, triangles);
  std::vector<int> triangle(hits.at.size());
  InterruptionStride stride;
  for (std::size_t row = 0; row < hits.at.size(); ++row) {
    stride.step();
    triangle[row] = hits.at[row].face < 0 ? -1 : cells.find(triangles, hits.at[row]);
  }
  TriangleCutter cutter(triangles);
  const auto insert = [&](std::size_t row, double tolerance) {
    InterruptionPoint::pass();  // a triangle that has been cut often has many pieces
    return cutter.insert(triangle[row], hits.at[row], tolerance);
  };
  // Ends come last, so that they find the curves at which they end.
  struct Ends {
    int second, last_but_one;  // points; -1 where there is no sample between the ends
  };
  std::vector<Ends> ends;
  ends.reserve(samples.first.size());
  for (std::size_t curve = 0; curve + 1 < samples.first.size(); ++curve) {
    Ends of_curve{-1, -1};
    for (std::size_t row = samples.first[curve] + 1; row + 1 < samples.first[curve + 1]; ++row) {
      const int point = insert(row, kSame);
      if (of_curve.second < 0) {
        of_curve.second = point;
      } else {
        cutter.connect(of_curve.last_but_one, point);
      }
      of_curve.last_but_one = point;
    }
    ends.push_back(of_curve);
  }
  for (std::size_t curve = 0; curve < ends.size(); ++curve) {
    const int first = insert(samples.first[curve], kReach);
    const int last = insert(samples.first[curve + 1] - 1, kReach);
    if (ends[curve].second < 0) {
      cutter.connect(first, last);
    } else {
      cutter.connect(first, ends[curve].second);
      cutter.connect(ends[curve].last_but_one, last);
    }
  }
  cutter.release();
}

}  // namespace

void cutAlongCurves(SurfaceTriangles& triangles, const LimitSurface& surface,
                    const std::vector<int>& levels, const Polylines& curves, int threads) {
  const double unit = ownUnit(triangles);
  for (Vector3& point : triangles.points) {
    point *= unit;
  }
  cutInUnit(triangles, unit, surface, levels, curves, threads);
  for (Vector3& point : triangles.points) {
    point /= unit;
  }
}

}  // namespace limitsurf
