// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/curvature/irregular_curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/vertex_approach.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Between planes whose normals are opposite there is no unique shortest rotation. Normals count as
/// opposite where 1 plus their product is below this, which is well above rounding.
constexpr double kOpposite = 1e-12;

/// How many places are evaluated before their means are formed, so that they take little memory.
constexpr std::size_t kPlacesAtOnce = std::size_t{1} << 16;

/// A place takes as long as several evaluations, and a mean takes as long as an evaluation for each
/// of its places.
constexpr std::size_t kPlacesPerTask = 64, kMeansPerTask = 64;

/// Whether the surface is singular at a place.
bool isSingular(const PrincipalCurvatures& curvature) {
  return !(curvature.direction1.allFinite() && curvature.direction2.allFinite());
}

Vector3 normalAt(const PrincipalCurvatures& curvature) {
  return curvature.direction1.cross(curvature.direction2);
}

}  // namespace

IrregularCurvature::IrregularCurvature(const TileTable& table, const Pose& pose,
                                       const PtexFaces& ptex, double radius)
    : table_(table),
      pose_(pose),
      ptex_(ptex),
      radius_(radius),
      corners_(table.ring_tiles.size()),
      first_tile_(table.rings.size() + 1) {
  findCorners();
  for (const RingTile& tile : table.ring_tiles) {
    ++first_tile_[tile.ring + 1];
  }
  for (std::size_t ring = 0; ring < table.rings.size(); ++ring) {
    first_tile_[ring + 1] += first_tile_[ring];
  }
}

void IrregularCurvature::findCorners() {
  for (std::size_t f = 0; f < table_.faces.size(); ++f) {
    const int face = static_cast<int>(f);
    const TileRef& whole = table_.faces[f];
    if (whole.kind == TileRef::kRing) {
      corners_[whole.index] = {face, table_.ring_tiles[whole.index].corner};
    } else if (whole.kind == TileRef::kSplit) {
      for (int corner = 0; corner < 4; ++corner) {
        TileRef child = table_.splits[whole.index][corner];
        while (child.kind == TileRef::kSplit) {
          child = table_.splits[child.index][0];
        }
        if (child.kind == TileRef::kRing) {
          corners_[child.index] = {face, corner};
        }
      }
    }
  }
}

std::vector<PrincipalCurvatures> IrregularCurvature::around(const std::vector<int>& rings,
                                                            int threads) const {
  std::vector<PrincipalCurvatures> result(rings.size());
  std::vector<int> tiles;           // of as many rings as are evaluated at once
  std::vector<std::size_t> starts;  // per such ring: its first place
  std::vector<Place> places;
  for (std::size_t begin = 0, end = 0; begin < rings.size(); begin = end) {
    tiles.clear();
    starts.clear();
    for (; end < rings.size() && tiles.size() * kPlacesPerFace < kPlacesAtOnce; ++end) {
      starts.push_back(tiles.size() * kPlacesPerFace);
      for (int i = 0; i < tileCount(rings[end]); ++i) {
        tiles.push_back(first_tile_[rings[end]] + i);
      }
    }
    places.resize(tiles.size() * kPlacesPerFace);
    parallelFor(places.size(), kPlacesPerTask, threads, [&](std::size_t from, std::size_t to) {
      TileEvaluator evaluator(table_, pose_);
      for (std::size_t i = from; i < to; ++i) {
        places[i] =
            place(evaluator, tiles[i / kPlacesPerFace], static_cast<int>(i % kPlacesPerFace));
      }
    });
    parallelFor(end - begin, kMeansPerTask, threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        result[begin + i] = mean(rings[begin + i], &places[starts[i]]);
      }
    });
  }
  return result;
}

IrregularCurvature::Place IrregularCurvature::place(TileEvaluator& evaluator, int ring_tile,
                                                    int number) const {
  const int base = ptex_.base_face[corners_[ring_tile].face];
  const bool is_quad = ptex_.first[base + 1] - ptex_.first[base] == 1;
  const double edge = is_quad ? 1 : 2;  // its length in u and v: a sub-face's sides are half edges
  Jet jet;
  const TileLocation at = locate(evaluator, ring_tile, edge * radius_, number);
  evaluator.evaluate<2>(at, jet);
  const FundamentalForms forms = evaluator.fundamentalForms(at, jet);
  const Vector3 du = jet.patch.du.head<3>(), dv = jet.patch.dv.head<3>();
  Place result;
  result.curvature = principalCurvatures(forms);
  result.scale = std::max(du.cwiseAbs().maxCoeff(), dv.cwiseAbs().maxCoeff());
  result.area =
      result.scale > 0 ? (du / result.scale).norm() * (dv / result.scale).norm() * forms.sine() : 0;
  result.scale *= edge;
  return result;
}

TileLocation IrregularCurvature::locate(const TileEvaluator& evaluator, int ring_tile, double side,
                                        int number) const {
  // Counter-clockwise: along the side u = side, then back along the side v = side.
  double u = number < 2 ? side : side * (number == 2 ? 0.75 : 0.25);
  double v = number < 2 ? side * (number == 0 ? 0.25 : 0.75) : side;
  const PtexCorner at = corners_[ring_tile];
  const int depth = table_.ring_tiles[ring_tile].depth;
  const double zoom = powerOfTwo(depth);
  if (side * zoom > 1) {
    turnParameters((4 - at.corner) & 3, u, v);
    return evaluator.locate({at.face, u, v});
  }
  // The place lies in the vertex's own tile, whose parameters begin at the vertex: no radius is too
  // small for them.
  const TileRef tile = {TileRef::kRing, static_cast<std::uint32_t>(ring_tile)};
  return {tile, u * zoom, v * zoom, at.corner, depth};
}

PrincipalCurvatures IrregularCurvature::mean(int ring, const Place* places) const {
  const int count = tileCount(ring) * kPlacesPerFace;
  double largest = 0;
  for (int i = 0; i < count; ++i) {
    largest = std::max(largest, places[i].scale);
  }
  std::vector<double> weights(count, 0.);
  for (int i = 0; i < count; ++i) {
    if (!isSingular(places[i].curvature)) {
      const double scale = places[i].scale / largest;
      weights[i] = places[i].area * scale * scale;
    }
  }
  const Vector3 normal = normalOf(ring, places, weights);
  const Eigen::Matrix3d axes = frame(Vector3::Zero(), Vector3::Zero(), normal);
  const Vector3 x = axes.col(0), y = axes.col(1);

  ShapeOperator sum{0, 0, 0};
  double total = 0;
  for (int i = 0; i < count; ++i) {
    if (weights[i] == 0) {
      continue;
    }
    const PrincipalCurvatures& k = places[i].curvature;
    const Vector3 there = normalAt(k), both = normal + there;
    const double towards = 1 + normal.dot(there);
    if (!(towards > kOpposite)) {  // this includes NaN, where the vertex has no normal
      continue;
    }
    const auto add = [&](double bend, const Vector3& direction) {
      const Vector3 turned = direction - normal.dot(direction) / towards * both;
      const double a = x.dot(turned), b = y.dot(turned);
      sum.xx += weights[i] * bend * a * a;
      sum.xy += weights[i] * bend * a * b;
      sum.yy += weights[i] * bend * b * b;
    };
    add(k.k1, k.direction1);
    add(k.k2, k.direction2);
    total += weights[i];
  }
  if (total == 0) {
    return {kNaN, kNaN, Vector3::Constant(kNaN), Vector3::Constant(kNaN)};
  }
  return principalCurvatures({sum.xx / total, sum.xy / total, sum.yy / total}, x, y);
}

Vector3 IrregularCurvature::normalOf(int ring, const Place* places,
                                     const std::vector<double>& weights) const {
  if (vertexHasNormal(table_.rings[ring].basis->ring())) {
    const Vector3 normal =
        unitDirection(vertexApproach(table_, pose_, first_tile_[ring], 0).normal);
    if (normal.allFinite()) {
      return normal;
    }
  }
  Vector3 sum = Vector3::Zero(), any = Vector3::Constant(kNaN);
  double total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0) {
      const Vector3 normal = normalAt(places[i].curvature);
      any = total == 0 ? normal : any;
      sum += weights[i] * normal;
      total += weights[i];
    }
  }
  return sum.norm() > kOpposite * total ? unitDirection(sum) : any;
}

}  // namespace limitsurf
