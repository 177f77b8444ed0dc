// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/fixed_samples.h"

#include <stdexcept>

#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/fixed/fixed_frame.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

constexpr std::size_t kRowsPerSampleTask = 4096;

}  // namespace

struct FixedSamples::Data {
  FixedPlan plan;
};

FixedSamples::FixedSamples(const LimitSurface& surface, const LocationBatch& at,
                           Derivatives derivatives, int threads) {
  if (derivatives == Derivatives::second) {
    throw std::invalid_argument("derivatives is 2; fixed samples have first derivatives at most");
  }
  const LocationBatch checked = surface.checkLocations(at, threads);
  const LimitSurface::Data& of = *surface.data_;
  const TileEvaluator evaluator(of.table, of.pose);
  const auto place = [&](std::size_t row) { return evaluator.locate(checked[row]); };
  data_.reset(new Data{{of.tiles, at.size(), place, static_cast<int>(derivatives), threads}});
}

FixedSamples::~FixedSamples() = default;
FixedSamples::FixedSamples(FixedSamples&&) noexcept = default;
FixedSamples& FixedSamples::operator=(FixedSamples&&) noexcept = default;

std::size_t FixedSamples::size() const { return data_->plan.rowCount(); }
Derivatives FixedSamples::derivatives() const {
  return static_cast<Derivatives>(data_->plan.order());
}
int FixedSamples::vertexCount() const { return data_->plan.vertexCount(); }
std::size_t FixedSamples::bytes() const { return data_->plan.bytes(); }

template <typename Real>
void FixedSamples::evaluate(const RowsIn<Points>& control_points,
                            const EvaluationArrays<Real>& results, int threads) const {
  checkThreads(threads);
  checkPositions(control_points, vertexCount(), threads);
  const bool first = derivatives() == Derivatives::first;
  PatchResults<Real> into{};
  into.position = checkedNumbers("position", results.position, size(), true);
  into.du = checkedNumbers("du", results.du, size(), first);
  into.dv = checkedNumbers("dv", results.dv, size(), first);
  const FixedFrame frame(data_->plan, control_points, threads);
  parallelFor(size(), kRowsPerSampleTask, threads,
              [&](std::size_t begin, std::size_t end) { frame.evaluate(begin, end, 0, into); });
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
  if (derivatives() == Derivatives::first) {
    arrays.du = rows(out.du);
    arrays.dv = rows(out.dv);
  }
  evaluate(control_points, arrays, threads);
  return out;
}

}  // namespace limitsurf
