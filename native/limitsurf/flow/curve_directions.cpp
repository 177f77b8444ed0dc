// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/flow/curve_directions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/flow/block_equations.h"
#include "limitsurf/flow/flow_mesh.h"
#include "limitsurf/parallel.h"
#include "limitsurf/search/line_pieces.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/work_aside.h"

namespace limitsurf {
namespace {

using Matrix2 = Eigen::Matrix2d;

/// How strongly the field is held at a curve, times the length of a quad's side: it leaves the
/// curve's direction by about 1/kHold of what it changes over a quad. (Held much more strongly, it
/// would overshoot beside curves that turn within a quad.)
constexpr double kHold = 10;
/// Keeps the system regular on parts of a surface that have no curve, times 1 / area.
constexpr double kRest = 1e-9;
/// Parts of curves that are steeper than this have no direction along the surface.
constexpr double kFlattest = 1e-3;
/// Shorter vectors of the field have no direction.
constexpr double kShortest = 1e-12;
/// Samples of a curve on the length of a quad's side.
constexpr double kSamplesPerSide = 2;

/// Pieces of curves: places in their middle, with the directions, as long as the pieces.
struct Samples {
  Points middle, along;
};

Samples sample(const Polylines& curves, double spacing) {
  const auto count = static_cast<Eigen::Index>(countPieces(curves, spacing, "points"));
  Samples samples{Points(count, 3), Points(count, 3)};
  Eigen::Index row = 0;
  InterruptionStride stride;
  forEachLine(curves, [&](const Vector3& from, const Vector3& to) {
    const auto parts = static_cast<double>(piecesOfLine(from, to, spacing));
    for (int i = 0; i < parts; ++i, ++row) {
      stride.step();
      samples.middle.row(row) = from + (i + 0.5) / parts * (to - from);
      samples.along.row(row) = (to - from) / parts;
    }
  });
  return samples;
}

Vector3 normalOf(const double* frame) { return {frame[2], frame[5], frame[8]}; }

/// The equations of the field: two unknowns for each vertex, its components in the vertex's plane.
class Equations {
 public:
  explicit Equations(const FlowMesh& mesh)
      : mesh_(mesh),
        blocks_(mesh.vertexCount()),
        right_(Eigen::VectorXd::Zero(2 * mesh.vertexCount())) {}

  /// Adds the integral of |grad X|^2. Each quad is the mean of its two divisions into triangles.
  void addChange() {
    blocks_.reserve(mesh_.quadCount() * 4 * 12);
    InterruptionStride stride;
    for (std::size_t i = 0; i < mesh_.quadCount(); ++i) {
      stride.step();
      const std::array<int, 4> v = mesh_.quad(i);
      for (int corner = 0; corner < 4; ++corner) {
        addTriangle({v[corner], v[(corner + 1) % 4], v[(corner + 2) % 4]}, 0.5);
      }
    }
    const double rest = kRest / mesh_.area() * mesh_.meanSide() * mesh_.meanSide();
    for (int i = 0; i < mesh_.vertexCount(); ++i) {
      blocks_.add(i, i, rest * Matrix2::Identity());
    }
  }

  /// Holds the field at a place to a vector of the plane with this normal, which may be taken as
  /// its weight times a unit vector.
  void hold(const FlowMesh::Place& place, const Vector3& normal, const Vector3& direction,
            double weight) {
    const PlaneBasis plane = planeBasis(normal);
    std::array<Matrix2, 4> into;
    for (int i = 0; i < 4; ++i) {
      into[i] = place.weights[i] * intoPlane(place.vertices[i], normal, plane);
    }
    const Eigen::Vector2d wanted = plane.transpose() * direction;
    for (int i = 0; i < 4; ++i) {
      right_.segment<2>(2 * place.vertices[i]) += weight * into[i].transpose() * wanted;
      for (int j = 0; j < 4; ++j) {
        blocks_.add(place.vertices[i], place.vertices[j], weight * into[i].transpose() * into[j]);
      }
    }
  }

  /// Solves the equations, which are gone then. Eigen's factorization, which takes seconds, passes
  /// no interruption points.
  Eigen::VectorXd solve() && {
    std::optional<Eigen::VectorXd> field = workAside(
        [blocks = std::move(blocks_), right = std::move(right_)] { return blocks.solve(right); });
    if (!field) {
      throw std::runtime_error("the directions of the curves cannot be continued");
    }
    return std::move(*field);
  }

 private:
  Matrix2 intoPlane(int vertex, const Vector3& normal, const PlaneBasis& plane) const {
    return plane.transpose() * turned(mesh_.basis(vertex), mesh_.normal(vertex), normal);
  }

  void addTriangle(const std::array<int, 3>& v, double share) {
    const std::array<Vector3, 3> p = {mesh_.position(v[0]), mesh_.position(v[1]),
                                      mesh_.position(v[2])};
    const Vector3 across = (p[1] - p[0]).cross(p[2] - p[0]);
    const double twice_area = across.norm();
    constexpr double kThinnest = 1e-10;
    const double longest = std::max(
        {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    if (!(twice_area > kThinnest * longest)) {
      return;
    }
    const Vector3 normal = across / twice_area;
    const PlaneBasis plane = planeBasis(normal);
    std::array<Matrix2, 3> into;
    for (int i = 0; i < 3; ++i) {
      into[i] = intoPlane(v[i], normal, plane);
    }
    for (int k = 0; k < 3; ++k) {  // the edge opposite of corner k has half the angle's cotangent
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double weight = share * (p[i] - p[k]).dot(p[j] - p[k]) / twice_area / 2;
      blocks_.add(v[i], v[i], weight * into[i].transpose() * into[i]);
      blocks_.add(v[j], v[j], weight * into[j].transpose() * into[j]);
      blocks_.add(v[i], v[j], -weight * into[i].transpose() * into[j]);
      blocks_.add(v[j], v[i], -weight * into[j].transpose() * into[i]);
    }
  }

  const FlowMesh& mesh_;
  BlockEquations blocks_;
  Eigen::VectorXd right_;
};

/// Holds the field to the curves. Returns the number of pieces that run along the surface.
std::size_t holdToCurves(const LimitSurface& surface, const FlowMesh& mesh, const Samples& samples,
                         int threads, Equations& equations) {
  const Hits hits = SurfaceSearch(surface, threads).closest(samples.middle, {}, threads);
  const auto frames = surface.frames(hits.at, threads);
  const double strength = kHold / mesh.meanSide() * mesh.scale();
  std::size_t held = 0;
  InterruptionStride stride;
  for (std::size_t row = 0; row < hits.at.size(); ++row) {
    stride.step();
    const Vector3 normal = normalOf(frames.row(static_cast<Eigen::Index>(row)).data());
    const Vector3 piece = samples.along.row(static_cast<Eigen::Index>(row));
    const Vector3 along = piece - normal * normal.dot(piece);
    const double length = along.norm();
    if (length > kFlattest * piece.norm()) {
      equations.hold(mesh.place(hits.at[row]), normal, along / length, strength * length);
      ++held;
    }
  }
  return held;
}

Points evaluate(const LimitSurface& surface, const FlowMesh& mesh, const Eigen::VectorXd& field,
                const LocationBatch& at, int threads) {
  const auto frames = surface.frames(at, threads);
  Points directions(static_cast<Eigen::Index>(at.size()), 3);
  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Vector3 normal = normalOf(frames.row(row).data());
      const FlowMesh::Place place = mesh.place(at[i]);
      Vector3 sum = Vector3::Zero();
      for (int k = 0; k < 4; ++k) {
        const int vertex = place.vertices[k];
        sum += place.weights[k] * (turned(mesh.basis(vertex), mesh.normal(vertex), normal) *
                                   field.segment<2>(2 * vertex));
      }
      const double length = sum.norm();
      directions.row(row) = length > kShortest ? Vector3(sum / length) : Vector3::Zero();
    }
  });
  return directions;
}

}  // namespace

Points curveDirections(const LimitSurface& surface, const Polylines& curves,
                       const LocationBatch& locations, int threads, const Progress& progress) {
  checkThreads(threads);
  checkPolylines(curves, "points", "offsets");
  const LocationBatch at = surface.checkLocations(locations, threads);
  const auto report = [&](double part) {
    if (progress) {
      progress(part);
    }
    InterruptionPoint::pass();
  };
  const FlowMesh mesh(surface, kFlowPolygons, threads);
  if (!(mesh.area() > 0)) {
    throw std::invalid_argument("the surface has no area");
  }
  report(0.1);
  Equations equations(mesh);
  equations.addChange();
  const Samples samples = sample(curves, mesh.meanSide() / mesh.scale() / kSamplesPerSide);
  if (holdToCurves(surface, mesh, samples, threads, equations) == 0) {
    throw std::invalid_argument("no part of a curve runs along the surface");
  }
  report(0.4);
  const Eigen::VectorXd field = std::move(equations).solve();
  report(0.9);
  Points directions = evaluate(surface, mesh, field, at, threads);
  report(1);
  return directions;
}

}  // namespace limitsurf
