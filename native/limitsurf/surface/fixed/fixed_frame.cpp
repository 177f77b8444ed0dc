// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/fixed_frame.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/surface/batch/patch_kernels.h"
#include "limitsurf/surface/fixed/pose_part.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

struct FixedPlan::Working {
  LargePageVector<Padded> points;
  PointsSize size;
  std::optional<Pose> pose;  // of what posed rows need
};

FixedPlan::FixedPlan(std::shared_ptr<const TiledSurface> tiles, std::size_t count,
                     const std::function<TileLocation(std::size_t)>& place, int order, int threads)
    : tiles_(std::move(tiles)), row_count_(count), order_(order) {
  if (count > std::numeric_limits<FixedRows::Row>::max()) {
    throw std::invalid_argument("there are " + std::to_string(count) +
                                " locations; the limit is 4294967295");
  }
  rows_ = FixedRows(tiles_->table, count, place, order, threads);
  std::vector<TileRef> posed;
  for (const TileLocation& at : rows_.posed.at) {
    posed.push_back(at.tile);
  }
  part_ = posePart(tiles_->table, std::move(posed));
}

FixedPlan::~FixedPlan() = default;

std::size_t FixedPlan::bytes() const {
  return rows_.bytes() + (part_.points.size() + part_.rings.size()) * sizeof(int);
}

FixedFrame::FixedFrame(const FixedPlan& plan, const RowsIn<Points>& control_points, int threads)
    : plan_(plan), working_(plan.kept_.take()) {
  if (!working_) {
    working_ = std::make_unique<FixedPlan::Working>();
  }
  working_->points.resize(static_cast<std::size_t>(control_points.rows()));
  working_->size = padPoints(control_points, working_->points.data(), threads);
  if (plan.rows_.posed.rows.empty()) {
    return;
  }
  if (!working_->pose) {
    working_->pose.emplace(plan.tiles_->table, &plan.part_);
  }
  working_->pose->set(control_points, threads);
}

FixedFrame::~FixedFrame() { plan_.kept_.giveBack(std::move(working_)); }

const PointsSize& FixedFrame::size() const { return working_->size; }

namespace {

template <typename Real>
void putRow(const Padded& from, Real* to) {
  for (int c = 0; c < 3; ++c) {
    to[c] = static_cast<Real>(from[c]);
  }
}

/// Calls body(place, count, rows) for the rows of a list from `begin` to `end`, a block at a time:
/// their places in the list, and their numbers from `first` on.
template <typename Body>
void forEachBlock(const std::vector<FixedRows::Row>& list, std::size_t begin, std::size_t end,
                  std::size_t first, const Body& body) {
  const auto placeOf = [&](std::size_t row) {
    // Within a block the rows may be in any order.
    return static_cast<std::size_t>(
        std::partition_point(list.begin(), list.end(),
                             [row](FixedRows::Row other) { return other < row; }) -
        list.begin());
  };
  std::size_t rows[FixedFrame::kRowsPerBlock];
  for (std::size_t place = placeOf(begin), last = placeOf(end); place < last;) {
    const std::size_t count = std::min(FixedFrame::kRowsPerBlock, last - place);
    for (std::size_t i = 0; i < count; ++i) {
      rows[i] = list[place + i] - first;
    }
    body(place, count, rows);
    place += count;
  }
}

}  // namespace

template <typename Real>
void FixedFrame::evaluate(std::size_t begin, std::size_t end, std::size_t first,
                          const PatchResults<Real>& results) const {
  const TileTable& table = plan_.tiles_->table;
  const PatchKernelsOf<Real>& kernels = PatchKernels::of<Real>();
  const int order = plan_.order_;
  const auto points = numbersOf(std::as_const(working_->points).data());

  const FixedRows::Single& single = plan_.rows_.single;
  forEachBlock(single.rows, begin, end, first,
               [&](std::size_t place, std::size_t count, const std::size_t* rows) {
                 const int* indices[kRowsPerBlock];
                 for (std::size_t i = 0; i < count; ++i) {
                   indices[i] = table.bsplines[single.tiles[place + i]].points.data();
                 }
                 SingleRun run;
                 run.points = points;
                 run.indices = indices;
                 run.u = single.u.data() + place;
                 run.v = single.v.data() + place;
                 run.rows = rows;
                 run.count = count;
                 kernels.singles[order](run, results);
               });

  const FixedRows::Weighted& weighted = plan_.rows_.weighted;
  forEachBlock(weighted.rows, begin, end, first,
               [&](std::size_t place, std::size_t count, const std::size_t* rows) {
                 kernels.weighted[order](
                     {points, weighted.offsets.data() + place, weighted.indices.data(),
                      weighted.weights.data(), place, rows, count},
                     results);
               });

  const FixedRows::Posed& posed = plan_.rows_.posed;
  if (posed.rows.empty()) {
    return;
  }
  TileEvaluator evaluator(table, *working_->pose);
  Jet jet;
  forEachBlock(posed.rows, begin, end, first,
               [&](std::size_t place, std::size_t count, const std::size_t* rows) {
                 for (std::size_t i = 0; i < count; ++i) {
                   evaluator.evaluateUpTo(order, posed.at[place + i], jet);
                   putRow<Real>(jet.anchor + jet.patch.value, results.position + 3 * rows[i]);
                   if (order == 1) {
                     putRow<Real>(jet.patch.du, results.du + 3 * rows[i]);
                     putRow<Real>(jet.patch.dv, results.dv + 3 * rows[i]);
                   }
                 }
               });
}

template void FixedFrame::evaluate(std::size_t, std::size_t, std::size_t,
                                   const PatchResults<double>&) const;
template void FixedFrame::evaluate(std::size_t, std::size_t, std::size_t,
                                   const PatchResults<float>&) const;

}  // namespace limitsurf
