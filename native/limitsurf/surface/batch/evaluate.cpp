// SPDX-License-Identifier: Apache-2.0
//
// Evaluation of batches, and LimitSurface::evaluate().
#include "limitsurf/error.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/batch/batch_evaluation.h"
#include "limitsurf/surface/batch/batch_evaluator.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// Rows of one task. Those of a face are divided among its patches, which pays if there are many.
constexpr std::size_t kBatchRowsPerTask = 2048;

/// Takes memory from the system for an array that has perhaps never been written to. Rows that come
/// in another order would take all of it at once, which lasts seconds for large arrays, and nobody
/// would hear Ctrl-C meanwhile.
template <typename Real>
void takeMemory(Real* numbers, std::size_t count, int threads) {
  constexpr std::size_t kPage = 4096 / sizeof(Real), kPagesPerTask = 512;
  if (numbers != nullptr) {
    parallelFor((count + kPage - 1) / kPage, kPagesPerTask, threads,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t page = begin; page < end; ++page) {
                    numbers[kPage * page] = 0;
                  }
                });
  }
}

}  // namespace

/// The batch is checked while it is evaluated.
template <typename Real>
void evaluateBatch(const TiledSurface& tiles, const Pose& pose, const LocationBatch& at,
                   Derivatives derivatives, const PatchResults<Real>& results, int threads) {
  const TileTable& table = tiles.table;
  constexpr std::size_t kRowBytes = 3 * sizeof(Real);
  std::size_t row_bytes = 0;
  const auto arrays = {results.position, results.du,  results.dv,    results.duu,
                       results.duv,      results.dvv, results.normal};
  for (const Real* const numbers : arrays) {
    row_bytes += numbers != nullptr ? kRowBytes : 0;
  }
  const RowOrder order(at, table, row_bytes, threads);
  if (order.isSorted()) {
    for (Real* const numbers : arrays) {
      takeMemory(numbers, 3 * at.size(), threads);
    }
  }
  try {
    parallelFor(at.size(), kBatchRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
      BatchEvaluator<Real>(table, pose, static_cast<int>(derivatives), results)
          .evaluate(at, order, begin, end);
    });
  } catch (const LocationError&) {
    tiles.check(at, threads);  // says which is the first row that is wrong, and why
    throw;
  }
}

template void evaluateBatch(const TiledSurface&, const Pose&, const LocationBatch&, Derivatives,
                            const PatchResults<double>&, int);
template void evaluateBatch(const TiledSurface&, const Pose&, const LocationBatch&, Derivatives,
                            const PatchResults<float>&, int);

Evaluation LimitSurface::evaluate(const LocationBatch& at, Derivatives derivatives, bool normals,
                                  int threads) const {
  checkThreads(threads);
  Evaluation out;
  resizeRows(out.position, at.size());
  if (derivatives >= Derivatives::first) {
    resizeRows(out.du, at.size());
    resizeRows(out.dv, at.size());
    if (normals) {
      resizeRows(out.normal, at.size());
    }
  }
  if (derivatives == Derivatives::second) {
    resizeRows(out.duu, at.size());
    resizeRows(out.duv, at.size());
    resizeRows(out.dvv, at.size());
  }
  const PatchResults<double> results{out.position.data(), out.du.data(),  out.dv.data(),
                                     out.duu.data(),      out.duv.data(), out.dvv.data(),
                                     out.normal.data()};
  evaluateBatch(*data_->tiles, data_->pose, at, derivatives, results, threads);
  return out;
}

template <typename Real>
void LimitSurface::evaluate(const LocationBatch& at, Derivatives derivatives,
                            const EvaluationArrays<Real>& results, int threads) const {
  checkThreads(threads);
  const auto of = [&](const char* name, const auto& rows, bool are_wanted) {
    return checkedNumbers(name, rows, at.size(), are_wanted);
  };
  const bool first = derivatives >= Derivatives::first, second = derivatives == Derivatives::second;
  const PatchResults<Real> into{of("position", results.position, true),
                                of("du", results.du, first),
                                of("dv", results.dv, first),
                                of("duu", results.duu, second),
                                of("duv", results.duv, second),
                                of("dvv", results.dvv, second),
                                of("normal", results.normal, first && results.normal.count > 0)};
  evaluateBatch(*data_->tiles, data_->pose, at, derivatives, into, threads);
}

template void LimitSurface::evaluate(const LocationBatch&, Derivatives,
                                     const EvaluationArrays<double>&, int) const;
template void LimitSurface::evaluate(const LocationBatch&, Derivatives,
                                     const EvaluationArrays<float>&, int) const;

}  // namespace limitsurf
