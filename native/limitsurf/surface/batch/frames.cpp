// SPDX-License-Identifier: Apache-2.0
//
// LimitSurface::frames().
#include <algorithm>

#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/batch/changed_locations.h"
#include "limitsurf/surface/batch/frame_kernels.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/face_corner.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// Derivatives and normals of so many rows stay in the cache until the frames are made of them.
constexpr std::size_t kRowsPerPart = std::size_t{1} << 15;

using Frame = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

/// Throws LocationError for a face that has no tile.
void checkFace(const TileTable& table, int face) {
  const auto index = static_cast<std::size_t>(face);
  if (index >= table.faces.size() || table.faces[index].kind == TileRef::kNone) {
    throwChangedLocations();
  }
}

}  // namespace

Rotations LimitSurface::frames(const LocationBatch& at, int threads) const {
  Rotations out(at.size(), 9);
  frames(at, {{}, {out.data(), at.size()}}, threads);
  return out;
}

void LimitSurface::frames(const LocationBatch& at, const FrameArrays& results, int threads) const {
  checkThreads(threads);
  const LocationBatch checked = checkLocations(at);
  const auto rows = static_cast<Eigen::Index>(at.size());
  checkRows("frame", static_cast<Eigen::Index>(results.frame.count), rows);
  const bool has_positions = results.position.numbers != nullptr;
  if (has_positions) {
    checkRows("position", static_cast<Eigen::Index>(results.position.count), rows);
  }
  // The same memory serves all parts: fresh memory costs as much as filling it.
  const auto most = static_cast<Eigen::Index>(std::min(kRowsPerPart, at.size()));
  Points position(has_positions ? 0 : most, 3), du(most, 3), dv(most, 3), normal(most, 3);
  for (std::size_t first = 0; first < at.size(); first += kRowsPerPart) {
    const LocationBatch part = checked.rows(first, std::min(kRowsPerPart, at.size() - first));
    double* const positions =
        has_positions ? results.position.numbers + 3 * first : position.data();
    evaluate<double>(part, Derivatives::first,
                     {{positions, part.size()},
                      {du.data(), part.size()},
                      {dv.data(), part.size()},
                      {},
                      {},
                      {},
                      {normal.data(), part.size()}},
                     threads);
    parallelFor(part.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
      constexpr std::size_t kRows = FrameKernels::kMostRows;
      const FrameKernels& kernels = FrameKernels::get();
      TileEvaluator evaluator(data_->table, data_->pose);
      unsigned found = 0;  // a bit for each of the rows that were found together
      for (std::size_t i = begin; i < end; ++i, found >>= 1) {
        const auto row = static_cast<Eigen::Index>(i);
        double* const numbers = results.frame.numbers + 9 * (first + i);
        if ((i - begin) % kRows == 0) {
          found = kernels.frames(du.row(row).data(), normal.row(row).data(), numbers,
                                 static_cast<int>(std::min(kRows, end - i)));
        }
        Frame rotation(numbers);
        const Location location = part[i];
        if (isCorner(location)) {
          checkFace(data_->table, location.face);
          const TileLocation place = evaluator.locate(location);
          if (place.atVertex()) {
            const VertexApproach towards = data_->approachTo(place);
            rotation = frame(towards.du, towards.dv, towards.normal);
            continue;
          }
        }
        if ((found & 1) == 0) {
          const Vector3 up = normal.row(row);
          rotation =
              frame(du.row(row), dv.row(row), up.allFinite() ? up : Vector3(Vector3::Zero()));
        }
      }
    });
  }
}

}  // namespace limitsurf
