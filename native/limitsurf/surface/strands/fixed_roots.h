// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "limitsurf/kept.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/fixed/fixed_frame.h"
#include "limitsurf/surface/fixed/pose_part.h"
#include "limitsurf/surface/strands/root_pose.h"

namespace limitsurf {

/// Roots of strands, which stay at their locations, found from the control points of one frame
/// after another. It refers to the topology of the surface, but to no pose of it.
class FixedRoots {
 public:
  FixedRoots(std::shared_ptr<const TiledSurface> tiles, std::vector<TileLocation> places,
             int threads);

  /// Whether such a root is found faster than on a surface that is posed for it: it depends on few
  /// vertices, which are no plain grid.
  static bool isFaster(const TileTable& table, const TileLocation& place);

  /// Calls move(i, root) for each place, in parallel, and then after(i) when some are done. The
  /// control points must have been checked.
  template <typename Move, typename After>
  void forEach(const RowsIn<Points>& control_points, const RootMap& map, int threads,
               const Move& move, const After& after) const;

 private:
  /// Whether the frame always takes more than du and dv.
  static bool isSpecial(const TileLocation& place) {
    return place.atVertex() || TileEvaluator::needsModeProducts(place);
  }
  using Numbers = std::vector<std::size_t>;  // of places

  PosePart partOf(const Numbers& some) const;
  /// The same for some of the places, on a pose.
  template <typename Move>
  void forEachOf(const Numbers& some, const Pose& pose, const RootMap& map, int threads,
                 const Move& move) const;

  std::shared_ptr<const TiledSurface> tiles_;
  std::vector<TileLocation> places_;
  Numbers planned_, special_;
  FixedPlan plan_;   // of the planned ones
  PosePart part_;    // of the special ones
  Kept<Pose> pose_;  // of that part
};

template <typename Move>
void FixedRoots::forEachOf(const Numbers& some, const Pose& pose, const RootMap& map, int threads,
                           const Move& move) const {
  parallelFor(some.size(), kRowsPerTask, threads, [&](std::size_t first, std::size_t last) {
    RootFinder root(tiles_->table, pose, map);
    for (std::size_t i = first; i < last; ++i) {
      move(some[i], root(places_[some[i]]));
    }
  });
}

template <typename Move, typename After>
void FixedRoots::forEach(const RowsIn<Points>& control_points, const RootMap& map, int threads,
                         const Move& move, const After& after) const {
  static_assert(kRowsPerTask % FixedFrame::kRowsPerBlock == 0, "tasks have whole blocks");
  const auto finish = [&](std::size_t i, const RootPose& root) {
    move(i, root);
    after(i);
  };
  if (!special_.empty()) {
    std::unique_ptr<Pose> pose = pose_.take();
    if (!pose) {
      pose = std::make_unique<Pose>(tiles_->table, &part_);
    }
    pose->set(control_points, threads);
    forEachOf(special_, *pose, map, threads, finish);
    pose_.giveBack(std::move(pose));
  }

  const FixedFrame frame(plan_, control_points, threads);
  // Where du and dv are too short or too close to parallel in this frame.
  std::vector<Numbers> late_of_tasks(planned_.size() / kRowsPerTask + 1);
  parallelFor(planned_.size(), kRowsPerTask, threads, [&](std::size_t first, std::size_t last) {
    double numbers[3][3 * kRowsPerTask];
    PatchResults<double> results{};
    results.position = numbers[0];
    results.du = numbers[1];
    results.dv = numbers[2];
    frame.evaluate(first, last, first, results);
    Numbers& late = late_of_tasks[first / kRowsPerTask];
    bool is_late[kRowsPerTask] = {};
    for (std::size_t row = first; row < last; ++row) {
      Padded vectors[3];
      for (int d = 0; d < 3; ++d) {
        const double* const from = numbers[d] + 3 * (row - first);
        vectors[d] = {from[0], from[1], from[2], 0};
      }
      const std::size_t i = planned_[row];
      RootPose root;
      if (map.carry(vectors[0], vectors[1], vectors[2],
                    TileEvaluator::normalLimits(frame.size(), 0, places_[i].depth), root)) {
        move(i, root);
      } else {
        late.push_back(i);
        is_late[row - first] = true;
      }
    }
    for (std::size_t row = first; row < last; ++row) {
      if (!is_late[row - first]) {
        after(planned_[row]);
      }
    }
  });
  Numbers late;
  for (const Numbers& of_task : late_of_tasks) {
    late.insert(late.end(), of_task.begin(), of_task.end());
  }
  if (!late.empty()) {
    const PosePart part = partOf(late);
    Pose pose(tiles_->table, &part);
    pose.set(control_points, threads);
    forEachOf(late, pose, map, threads, finish);
  }
}

}  // namespace limitsurf
