// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/displace/displacement.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/surface/complete_normals.h"

namespace limitsurf {
namespace {

using Frame = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

/// The columns of a frame.
constexpr int kTangent = 0, kBitangent = 1, kNormal = 2;

void requireAsMany(Eigen::Index a, const char* name_a, Eigen::Index b, const char* name_b) {
  if (a != b) {
    throw std::invalid_argument(std::to_string(a) + " " + name_a + " and " + std::to_string(b) +
                                " " + name_b);
  }
}

struct PointsAndNormals {
  Points position, normal;
};

/// Positions and normals of the base. Normals are unit vectors everywhere.
PointsAndNormals pointsAndNormals(const LimitSurface& base, const LocationBatch& at, int threads) {
  Evaluation here = base.evaluate(at, Derivatives::first, true, threads);
  completeNormals(base, at, here.normal, threads);
  return {std::move(here.position), std::move(here.normal)};
}

}  // namespace

Points vectorDisplacement(const LimitSurface& base, const LimitSurface& target,
                          const SubdividedFaces& faces, const LocationBatch& at, int threads) {
  const LocationBatch on_base = base.checkLocations(at, threads);
  return target.evaluate(faces.locate(at, threads), Derivatives::none, false, threads).position -
         base.evaluate(on_base, Derivatives::none, false, threads).position;
}

Points intoFrames(const Points& vectors, const FrameRows& frames) {
  requireAsMany(vectors.rows(), "vectors", frames.rows(), "frames");
  Points result(vectors.rows(), 3);
  for (Eigen::Index row = 0; row < vectors.rows(); ++row) {
    const Eigen::RowVector3d along = vectors.row(row) * Frame(frames.row(row).data());
    result.row(row) << along[kTangent], along[kNormal], along[kBitangent];
  }
  return result;
}

Points outOfFrames(const Points& components, const FrameRows& frames) {
  requireAsMany(components.rows(), "vectors", frames.rows(), "frames");
  Points result(components.rows(), 3);
  for (Eigen::Index row = 0; row < components.rows(); ++row) {
    const Frame frame(frames.row(row).data());
    result.row(row) = components(row, 0) * frame.col(kTangent) +
                      components(row, 1) * frame.col(kNormal) +
                      components(row, 2) * frame.col(kBitangent);
  }
  return result;
}

Points displaced(const LimitSurface& base, const LocationBatch& at, const Points& components,
                 const FrameRows& frames, int threads) {
  requireAsMany(static_cast<Eigen::Index>(at.size()), "locations", components.rows(), "vectors");
  const Points positions = base.evaluate(at, Derivatives::none, false, threads).position;
  return positions + (frames.rows() > 0 ? outOfFrames(components, frames) : components);
}

Eigen::VectorXd scalarDisplacement(const LimitSurface& base, const SurfaceSearch& target,
                                   const LocationBatch& at,
                                   const ScalarDisplacementOptions& options, int threads) {
  const PointsAndNormals here = pointsAndNormals(base, at, threads);
  const auto distances = [&](double sign) -> Eigen::VectorXd {
    return target.rayCast(here.position, sign * here.normal, options.max_distance, threads)
        .distance;
  };
  switch (options.direction) {
    case RayDirection::outward:
      return distances(1);
    case RayDirection::inward:
      return -distances(-1);
    case RayDirection::both:
      break;
  }
  const Eigen::VectorXd outward = distances(1), inward = distances(-1);
  Eigen::VectorXd result(outward.size());
  for (Eigen::Index row = 0; row < result.size(); ++row) {
    const bool inwards = std::isnan(outward[row]) || inward[row] < outward[row];
    result[row] = inwards ? -inward[row] : outward[row];
  }
  return result;
}

Points displacedAlongNormals(const LimitSurface& base, const LocationBatch& at,
                             const Eigen::VectorXd& distances, int threads) {
  requireAsMany(static_cast<Eigen::Index>(at.size()), "locations", distances.size(), "distances");
  const PointsAndNormals here = pointsAndNormals(base, at, threads);
  return here.position + distances.asDiagonal() * here.normal;
}

}  // namespace limitsurf
