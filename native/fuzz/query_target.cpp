// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "fuzz/random_mesh.h"
#include "fuzz/require.h"
#include "fuzz/targets.h"
#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/curves/scatter_along.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/tessellate/tessellation.h"

namespace limitsurf::fuzz {
namespace {

constexpr int kQueries = 6, kLocations = 10, kOperations = 4;
/// What rounding may add to distances, relative to the mesh and the distance itself.
constexpr double kSlack = 1e-11;

Points readPoints(ByteReader& bytes, const LimitSurface& surface) {
  // In the mesh's own size, around its first vertex.
  const double size = std::max(diagonalOf(surface), 1e-200);
  Points points(kQueries, 3);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      points(row, axis) = surface.positions()(0, axis) + size * bytes.coordinate();
    }
  }
  return points;
}

void checkLocations(const LimitSurface& surface, const std::vector<Location>& at) {
  surface.evaluate(at, Derivatives::none, false, 1);  // throws for one that is out of range
}

void checkClosest(ByteReader& bytes, const LimitSurface& surface, const SurfaceSearch& search) {
  const Points points = readPoints(bytes, surface);
  Hits hits;
  if (!accepts([&] { hits = search.closest(points, {}, 1); })) {
    return;
  }
  const std::vector<Location> at = readLocations(bytes, surface, kLocations);
  const Points others = surface.evaluate(at, Derivatives::none, false, 1).position;
  const double diagonal = diagonalOf(surface);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    require(at.empty() || hits.at[static_cast<std::size_t>(row)].face >= 0,
            "a surface has a closest point");
    for (Eigen::Index i = 0; i < others.rows(); ++i) {
      const double distance = (points.row(row) - others.row(i)).stableNorm();
      require(hits.distance[row] <= distance + kSlack * (distance + diagonal),
              "no point is closer than the closest");
    }
  }
}

void checkFacing(ByteReader& bytes, const LimitSurface& surface, const SurfaceSearch& search) {
  ClosestOptions options;
  const Points points = readPoints(bytes, surface);
  options.facing = Points(points.rows(), 3);
  for (Eigen::Index i = 0; i < options.facing.size(); ++i) {
    options.facing.data()[i] = bytes.coordinate();
  }
  options.max_angle = 3 * bytes.parameter();
  options.max_distance = 10 * diagonalOf(surface) * bytes.parameter();
  accepts([&] {
    const Hits hits = search.closest(points, options, 1);
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      if (hits.at[static_cast<std::size_t>(row)].face >= 0) {
        require(hits.distance[row] <=
                    options.max_distance * (1 + kSlack) + kSlack * diagonalOf(surface),
                "a hit is within the largest distance");
      }
    }
  });
}

void checkRays(ByteReader& bytes, const LimitSurface& surface, const SurfaceSearch& search) {
  const Points origins = readPoints(bytes, surface);
  Points directions(origins.rows(), 3);
  for (Eigen::Index i = 0; i < directions.size(); ++i) {
    directions.data()[i] = bytes.coordinate();
  }
  accepts([&] {
    const double far = std::numeric_limits<double>::infinity();
    const Hits first = search.rayCast(origins, directions, far, 1);
    const RayHits all = search.rayCastAll(origins, directions, far, 1);
    for (Eigen::Index row = 0; row < origins.rows(); ++row) {
      const auto i = static_cast<std::size_t>(row);
      const bool hit = first.at[i].face >= 0;
      require(hit == (all.offsets[i] < all.offsets[i + 1]), "both ways of casting rays agree");
      if (!hit) {
        continue;
      }
      const Vector3 way = first.position.row(row) - origins.row(row);
      const Vector3 along = directions.row(row).transpose().stableNormalized();
      const double reach = way.stableNorm() + diagonalOf(surface);
      // Far from the origin, coordinates themselves are rounded by more.
      const double rounding = 1e-15 * first.position.row(row).stableNorm();
      require((way - way.dot(along) * along).stableNorm() <= 1e-9 * reach + rounding,
              "a hit is on its ray");
    }
  });
}

void checkScattering(ByteReader& bytes, const LimitSurface& surface) {
  accepts([&] {
    const int per_side = 1 + bytes.below(3);
    const auto seed = static_cast<std::uint64_t>(bytes.byte());
    checkLocations(surface, scatterJittered(surface, per_side, seed, 1));
    const AreaSampler sampler(surface, 1);
    const auto count = static_cast<std::int64_t>(bytes.below(40));
    const std::vector<Location> uniform = sampler.uniform(count, 1, {}, 1);
    require(static_cast<std::int64_t>(uniform.size()) == count, "there are as many as asked for");
    checkLocations(surface, uniform);
    // A density that is u, with limits on the two halves of each face.
    std::vector<double> limits;
    for (int face = 0; face < surface.faceCount(); ++face) {
      limits.insert(limits.end(), {0.5, 1, 0.5, 1});
    }
    const Density along_u(
        [](Span<Location> at, double* weights) {
          for (const Location& l : at) {
            *weights++ = l.u;
          }
        },
        DensityLimits(2, std::move(limits)));
    checkLocations(surface, sampler.uniform(count, 1, along_u, 1));
  });
}

void checkBlueNoise(ByteReader& bytes, const LimitSurface& surface) {
  accepts([&] {
    const AreaSampler sampler(surface, 1);
    BlueNoiseOptions options;
    if (bytes.flag()) {
      options.count = bytes.below(40);
    } else {
      options.radius = diagonalOf(surface) * (0.05 + bytes.byte() / 256.);
    }
    const BlueNoise noise = sampler.blueNoise(options, 1);
    require(!options.count || static_cast<std::int64_t>(noise.at.size()) == *options.count,
            "there are as many as asked for");
    checkLocations(surface, noise.at);
  });
}

void checkCurves(ByteReader& bytes, const LimitSurface& surface) {
  accepts([&] {
    const EdgeCurves curves(surface, bytes.flag() ? EdgeChoice::boundary : EdgeChoice::creases, 1);
    for (int curve = 0; curve < curves.count(); ++curve) {
      require(curves.length(curve) >= 0 && std::isfinite(curves.length(curve)),
              "a length is a number");
    }
    if (curves.count() == 0) {
      return;
    }
    AlongOptions options;
    options.count = bytes.below(20);
    options.jitter = bytes.byte() / 255.;
    options.rows = 1 + bytes.below(3);
    options.row_distance = diagonalOf(surface) * bytes.byte() / 1024.;
    checkLocations(surface, scatterAlong(surface, curves, options, 1).at);
  });
}

void checkPolygons(ByteReader& bytes, const LimitSurface& surface) {
  accepts([&] {
    TessellationOptions options;
    options.threads = 1;
    options.corner_normals = bytes.flag();
    std::vector<int> levels(surface.mesh().faceSizes().size());
    for (int& level : levels) {
      level = bytes.below(3);
    }
    const Tessellation made = tessellate(surface, levels, options);
    require(made.positions.allFinite() && made.normals.allFinite(), "polygons are finite");
    for (const int point : made.face_vertices) {
      require(point >= 0 && point < made.positions.rows(), "polygons have their points");
    }
  });
}

}  // namespace

void queryTarget(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const std::unique_ptr<LimitSurface> surface = readSurface(bytes);
  if (!surface) {
    return;
  }
  const SurfaceSearch search(*surface, 1);
  for (int i = 0; i < kOperations; ++i) {
    switch (bytes.below(7)) {
      case 0:
        checkClosest(bytes, *surface, search);
        break;
      case 1:
        checkFacing(bytes, *surface, search);
        break;
      case 2:
        checkRays(bytes, *surface, search);
        break;
      case 3:
        checkScattering(bytes, *surface);
        break;
      case 4:
        checkBlueNoise(bytes, *surface);
        break;
      case 5:
        checkCurves(bytes, *surface);
        break;
      default:
        checkPolygons(bytes, *surface);
    }
  }
}

}  // namespace limitsurf::fuzz
