// SPDX-License-Identifier: Apache-2.0
//
// LimitSurface::frames().
#include <algorithm>

#include "limitsurf/batch_parts.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/batch/changed_locations.h"
#include "limitsurf/surface/batch/frame_kernels.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/face_corner.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// What frames are made of. The positions are empty where the caller wants them.
struct FrameInputs {
  Points position, du, dv, normal;
};

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
  const LocationBatch checked = checkLocations(at, threads);
  const auto rows = static_cast<Eigen::Index>(at.size());
  checkRows("frame", static_cast<Eigen::Index>(results.frame.count), rows);
  const bool has_positions = results.position.numbers != nullptr;
  if (has_positions) {
    checkRows("position", static_cast<Eigen::Index>(results.position.count), rows);
  }
  const auto makeFrames = [this](const LocationBatch& part, const FrameInputs& of,
                                 double* numbers) {
    constexpr std::size_t kRows = FrameKernels::kMostRows;
    const FrameKernels& kernels = FrameKernels::get();
    TileEvaluator evaluator(data_->table, data_->pose);
    unsigned found = 0;  // a bit for each of the rows that were found together
    for (std::size_t i = 0; i < part.size(); ++i, found >>= 1, numbers += 9) {
      const auto row = static_cast<Eigen::Index>(i);
      if (i % kRows == 0) {
        found = kernels.frames(of.du.row(row).data(), of.normal.row(row).data(), numbers,
                               static_cast<int>(std::min(kRows, part.size() - i)));
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
        const Vector3 up = of.normal.row(row);
        rotation =
            frame(of.du.row(row), of.dv.row(row), up.allFinite() ? up : Vector3(Vector3::Zero()));
      }
    }
  };
  const auto inputs = [&](std::size_t count) {
    const auto some = static_cast<Eigen::Index>(count);
    return FrameInputs{Points(has_positions ? 0 : some, 3), Points(some, 3), Points(some, 3),
                       Points(some, 3)};
  };
  forEachPart(at.size(), threads, inputs, [&](std::size_t begin, std::size_t end, FrameInputs& of) {
    const LocationBatch part = checked.rows(begin, end - begin);
    double* const positions =
        has_positions ? results.position.numbers + 3 * begin : of.position.data();
    evaluate<double>(part, Derivatives::first,
                     {{positions, part.size()},
                      {of.du.data(), part.size()},
                      {of.dv.data(), part.size()},
                      {},
                      {},
                      {},
                      {of.normal.data(), part.size()}},
                     1);
    makeFrames(part, of, results.frame.numbers + 9 * begin);
  });
}

}  // namespace limitsurf
