// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/fixed_samples.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "limitsurf/large_pages.h"
#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/batch/patch_kernels.h"
#include "limitsurf/surface/fixed/fixed_rows.h"
#include "limitsurf/surface/fixed/pose_part.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

constexpr std::size_t kRowsPerSampleTask = 4096, kPointsPerCopy = 16384;
/// Rows that a kernel gets at a time.
constexpr std::size_t kRowsPerRun = 64;

using PaddedPoints = LargePageVector<Padded>;

/// What one call works with.
struct Working {
  PaddedPoints points;
  std::optional<Pose> pose;  // of what posed rows need
};

/// Keeps what a call worked with for the next one: to get the memory from the system takes as long
/// as to fill it. Calls that run at the same time do not share it.
class KeptWorking {
 public:
  KeptWorking() = default;
  KeptWorking(const KeptWorking&) = delete;
  KeptWorking& operator=(const KeptWorking&) = delete;
  ~KeptWorking() { delete kept_.load(); }

  std::unique_ptr<Working> take() const {
    std::unique_ptr<Working> working(kept_.exchange(nullptr));
    return working ? std::move(working) : std::make_unique<Working>();
  }
  void giveBack(std::unique_ptr<Working> working) const {
    delete kept_.exchange(working.release());
  }

 private:
  mutable std::atomic<Working*> kept_{nullptr};
};

void setPadded(const RowsIn<Points>& from, PaddedPoints& to, int threads) {
  const auto count = static_cast<std::size_t>(from.rows());
  to.resize(count);
  parallelFor(count, kPointsPerCopy, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double* const xyz = from.data() + 3 * i;
      to[i] = Padded(xyz[0], xyz[1], xyz[2], 0);
    }
  });
}

/// Calls body(begin, count, rows) for runs of a list's rows, in parallel.
template <typename Body>
void forEachRun(const std::vector<FixedRows::Row>& list, int threads, const Body& body) {
  parallelFor(list.size(), kRowsPerSampleTask, threads, [&](std::size_t first, std::size_t last) {
    std::size_t rows[kRowsPerRun];
    for (std::size_t begin = first; begin < last; begin += kRowsPerRun) {
      const std::size_t count = std::min(kRowsPerRun, last - begin);
      std::copy_n(list.data() + begin, count, rows);
      body(begin, count, rows);
    }
  });
}

template <typename Real>
void putRow(const Padded& from, Real* to) {
  for (int c = 0; c < 3; ++c) {
    to[c] = static_cast<Real>(from[c]);
  }
}

}  // namespace

struct FixedSamples::Data {
  template <typename Real>
  void evaluateSingle(const PaddedPoints& points, const PatchResults<Real>& results,
                      int threads) const;
  template <typename Real>
  void evaluateWeighted(const PaddedPoints& points, const PatchResults<Real>& results,
                        int threads) const;
  template <typename Real>
  void evaluatePosed(const RowsIn<Points>& cage, std::optional<Pose>& pose,
                     const PatchResults<Real>& results, int threads) const;

  std::shared_ptr<const TiledSurface> tiles;
  std::size_t size;
  Derivatives derivatives;
  FixedRows rows;
  PosePart part;  // what rows.posed need
  KeptWorking kept;
};

template <typename Real>
void FixedSamples::Data::evaluateSingle(const PaddedPoints& points,
                                        const PatchResults<Real>& results, int threads) const {
  const FixedRows::Single& single = rows.single;
  const auto kernel = PatchKernels::get().evaluateSingles<Real>(static_cast<int>(derivatives));
  forEachRun(single.rows, threads,
             [&](std::size_t begin, std::size_t count, const std::size_t* of) {
               const int* indices[kRowsPerRun];
               for (std::size_t i = 0; i < count; ++i) {
                 indices[i] = tiles->table.bsplines[single.tiles[begin + i]].points.data();
               }
               SingleRun run;
               run.points = numbersOf(points.data());
               run.indices = indices;
               run.u = single.u.data() + begin;
               run.v = single.v.data() + begin;
               run.rows = of;
               run.count = count;
               kernel(run, results);
             });
}

template <typename Real>
void FixedSamples::Data::evaluateWeighted(const PaddedPoints& points,
                                          const PatchResults<Real>& results, int threads) const {
  const FixedRows::Weighted& weighted = rows.weighted;
  const auto kernel = PatchKernels::get().evaluateWeighted<Real>(static_cast<int>(derivatives));
  forEachRun(weighted.rows, threads,
             [&](std::size_t begin, std::size_t count, const std::size_t* of) {
               kernel({numbersOf(points.data()), weighted.offsets.data() + begin,
                       weighted.indices.data(), weighted.weights.data(), begin, of, count},
                      results);
             });
}

template <typename Real>
void FixedSamples::Data::evaluatePosed(const RowsIn<Points>& cage, std::optional<Pose>& pose,
                                       const PatchResults<Real>& results, int threads) const {
  const FixedRows::Posed& posed = rows.posed;
  if (posed.rows.empty()) {
    return;
  }
  if (!pose) {
    pose.emplace(tiles->table, &part);
  }
  pose->set(cage, threads);
  parallelFor(posed.rows.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    TileEvaluator evaluator(tiles->table, *pose);
    Jet jet;
    for (std::size_t i = begin; i < end; ++i) {
      evaluator.evaluateUpTo(static_cast<int>(derivatives), posed.at[i], jet);
      const std::size_t at = 3 * std::size_t{posed.rows[i]};
      putRow<Real>(jet.anchor + jet.patch.value, results.position + at);
      if (derivatives == Derivatives::first) {
        putRow<Real>(jet.patch.du, results.du + at);
        putRow<Real>(jet.patch.dv, results.dv + at);
      }
    }
  });
}

FixedSamples::FixedSamples(const LimitSurface& surface, const LocationBatch& at,
                           Derivatives derivatives, int threads)
    : data_(std::make_unique<Data>()) {
  if (derivatives == Derivatives::second) {
    throw std::invalid_argument("derivatives is 2; fixed samples have first derivatives at most");
  }
  if (at.size() > std::numeric_limits<FixedRows::Row>::max()) {
    throw std::invalid_argument("there are " + std::to_string(at.size()) +
                                " locations; the limit is 4294967295");
  }
  const LocationBatch checked = surface.checkLocations(at, threads);
  const LimitSurface::Data& of = *surface.data_;
  data_->tiles = of.tiles;
  data_->size = at.size();
  data_->derivatives = derivatives;
  data_->rows = FixedRows(checked, TileEvaluator(of.table, of.pose), of.table,
                          static_cast<int>(derivatives), threads);
  std::vector<TileRef> posed;
  for (const TileLocation& place : data_->rows.posed.at) {
    posed.push_back(place.tile);
  }
  if (!posed.empty()) {
    data_->part = posePart(of.table, std::move(posed));
  }
}

FixedSamples::~FixedSamples() = default;
FixedSamples::FixedSamples(FixedSamples&&) noexcept = default;
FixedSamples& FixedSamples::operator=(FixedSamples&&) noexcept = default;

std::size_t FixedSamples::size() const { return data_->size; }
Derivatives FixedSamples::derivatives() const { return data_->derivatives; }
int FixedSamples::vertexCount() const { return data_->tiles->table.points.cagePoints(); }
std::size_t FixedSamples::bytes() const {
  return data_->rows.bytes() + (data_->part.points.size() + data_->part.rings.size()) * sizeof(int);
}

template <typename Real>
void FixedSamples::evaluate(const RowsIn<Points>& control_points,
                            const EvaluationArrays<Real>& results, int threads) const {
  checkThreads(threads);
  checkPositions(control_points, vertexCount(), threads);
  const bool first = data_->derivatives == Derivatives::first;
  const auto of = [&](const char* name, const typename EvaluationArrays<Real>::Rows& array,
                      bool wanted) {
    if (!wanted) {
      return static_cast<Real*>(nullptr);
    }
    checkRows(name, static_cast<Eigen::Index>(array.count), static_cast<Eigen::Index>(size()));
    return array.numbers;
  };
  PatchResults<Real> into{};
  into.position = of("position", results.position, true);
  into.du = of("du", results.du, first);
  into.dv = of("dv", results.dv, first);
  std::unique_ptr<Working> working = data_->kept.take();
  setPadded(control_points, working->points, threads);
  data_->evaluateSingle(working->points, into, threads);
  data_->evaluateWeighted(working->points, into, threads);
  data_->evaluatePosed(control_points, working->pose, into, threads);
  data_->kept.giveBack(std::move(working));
}

template void FixedSamples::evaluate(const RowsIn<Points>&, const EvaluationArrays<double>&,
                                     int) const;
template void FixedSamples::evaluate(const RowsIn<Points>&, const EvaluationArrays<float>&,
                                     int) const;

Evaluation FixedSamples::evaluate(const RowsIn<Points>& control_points, int threads) const {
  Evaluation out;
  const auto rows = [&](Points& points) {
    resizeRows(points, size());
    return EvaluationArrays<double>::Rows{points.data(), size()};
  };
  EvaluationArrays<double> arrays;
  arrays.position = rows(out.position);
  if (data_->derivatives == Derivatives::first) {
    arrays.du = rows(out.du);
    arrays.dv = rows(out.dv);
  }
  evaluate(control_points, arrays, threads);
  return out;
}

}  // namespace limitsurf
