// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <cmath>
#include <cstring>

#include "fuzz/random_mesh.h"
#include "fuzz/require.h"
#include "fuzz/targets.h"
#include "limitsurf/sample/area.h"

namespace limitsurf::fuzz {
namespace {

constexpr int kLocations = 12;

bool sameBits(const double* a, const double* b, int count) {
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(double)) == 0;
}

/// A row of what was evaluated for many locations, against the same location by itself.
void checkBatch(const LimitSurface& surface, const std::vector<Location>& at, const Evaluation& e) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Evaluation alone = surface.evaluate({&at[i], 1}, Derivatives::second, true, 1);
    const auto same = [&](const Points& all, const Points& one) {
      return sameBits(all.row(row).data(), one.row(0).data(), 3);
    };
    require(same(e.position, alone.position) && same(e.du, alone.du) && same(e.dv, alone.dv) &&
                same(e.duu, alone.duu) && same(e.duv, alone.duv) && same(e.dvv, alone.dvv) &&
                same(e.normal, alone.normal),
            "the result for a location does not depend on the batch");
  }
}

void checkEvaluation(const LimitSurface& surface, const std::vector<Location>& at) {
  const Evaluation e = surface.evaluate(at, Derivatives::second, true, 1);
  const Points& cage = surface.positions();
  const Eigen::RowVector3d low = cage.colwise().minCoeff(), high = cage.colwise().maxCoeff();
  const double largest = cage.cwiseAbs().maxCoeff();
  for (Eigen::Index row = 0; row < e.position.rows(); ++row) {
    require(e.position.row(row).allFinite(), "positions are finite");
    const double margin = 1e-13 * largest;
    require(((e.position.row(row) - low).array() >= -margin).all() &&
                ((high - e.position.row(row)).array() >= -margin).all(),
            "the surface lies within the box of the control points");
    const double length = e.normal.row(row).norm();
    require(std::isnan(length) || std::abs(length - 1) < 1e-12, "a normal is a unit vector or NaN");
  }
  checkBatch(surface, at, e);
}

void checkFrames(const LimitSurface& surface, const std::vector<Location>& at) {
  const auto frames = surface.frames(at, 1);
  for (Eigen::Index row = 0; row < frames.rows(); ++row) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(
        frames.row(row).data());
    require((frame.transpose() * frame - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-12,
            "a frame is a rotation");
    require(frame.determinant() > 0, "a frame is right-handed");
  }
}

void checkStencils(const LimitSurface& surface, const std::vector<Location>& at) {
  const Stencils stencils = surface.stencils(at, false, 1);
  const Evaluation e = surface.evaluate(at, Derivatives::none, false, 1);
  const double largest = surface.positions().cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < at.size(); ++i) {
    double sum = 0;
    Eigen::RowVector3d position = Eigen::RowVector3d::Zero();
    for (auto k = static_cast<std::size_t>(stencils.offsets[i]);
         k < static_cast<std::size_t>(stencils.offsets[i + 1]); ++k) {
      sum += stencils.weights[k];
      position += stencils.weights[k] * surface.positions().row(stencils.indices[k]);
    }
    require(std::abs(sum - 1) < 1e-12, "weights add up to 1");
    require((position - e.position.row(static_cast<Eigen::Index>(i))).cwiseAbs().maxCoeff() <=
                1e-12 * largest,
            "stencils give the position");
  }
}

void checkArea(const LimitSurface& surface) {
  const SurfaceArea area = measuredArea(surface, 1);
  require(area.value >= 0 && std::isfinite(area.value) && area.error >= 0, "an area is a number");
}

void checkPoses(ByteReader& bytes, LimitSurface& surface) {
  Points moved = surface.positions();
  const double coordinate = bytes.coordinate();
  const Eigen::Index row = bytes.byte() % moved.rows();
  moved(row, bytes.below(3)) = coordinate;
  const Points before = surface.positions();
  if (!accepts([&] { surface.setPositions(moved, 1); })) {
    require(surface.positions() == before, "a pose that is refused changes nothing");
  }
}

}  // namespace

void meshTarget(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const std::unique_ptr<LimitSurface> surface = readSurface(bytes);
  if (!surface) {
    return;
  }
  for (int pose = 0; pose < 2; ++pose) {
    const std::vector<Location> at = readLocations(bytes, *surface, kLocations);
    checkEvaluation(*surface, at);
    checkFrames(*surface, at);
    checkStencils(*surface, at);
    surface->curvature(at, IrregularRule::average, 1. / 64, 1);
    surface->tiles(at, SurfaceTiles::kDefaultDepth, 1);
    checkArea(*surface);
    checkPoses(bytes, *surface);
  }
}

}  // namespace limitsurf::fuzz
