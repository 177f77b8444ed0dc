// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "limitsurf/float_rounding.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/parallel.h"
#include "limitsurf/pi.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/row_check.h"
#include "limitsurf/search/box_queries.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/search/closest_on_cores.h"
#include "limitsurf/search/closest_on_patch.h"
#include "limitsurf/search/hit_evaluation.h"
#include "limitsurf/search/normals/normal_cones.h"
#include "limitsurf/search/spatial_order.h"
#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {
namespace {

/// A direction in a unit of its own, a power of two, so that its square can be formed.
Vector3 inUnit(const Vector3& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  return {std::scalbn(direction[0], -std::ilogb(largest)),
          std::scalbn(direction[1], -std::ilogb(largest)),
          std::scalbn(direction[2], -std::ilogb(largest))};
}

/// Most rows look at a few leaves and parts of patches, but among sheets that lie on each other, or
/// on patches that are nearly lines, at thousands. So many take about a millisecond.
constexpr std::int64_t kWorkPerPass = 1024;
/// A task that has looked at so many leaves its other rows to smaller tasks, in which all threads
/// can share: a few hundred rows that take long would be one task.
constexpr std::int64_t kWorkPerTask = 1 << 15;
/// By how much those are smaller.
constexpr std::size_t kSmaller = 8;
/// Points are fetched so many searches ahead: in the order of searches they are scattered.
constexpr std::size_t kPrefetched = 4;
/// Angles from here on count as pi, and then no cosine is too small.
constexpr double kNearlyPi = kPi<double> - 1e-13, kAnyCosine = -2;

/// Searches for one point after the other.
class ClosestSearch {
 public:
  /// With `cones`, subtrees are left out whose normals do not meet the condition. Results are the
  /// same to the last bit.
  explicit ClosestSearch(const SearchTree& data, const NormalCones* cones = nullptr)
      : data_(data), cones_(cones), cache_(data), cores_(data, best_) {}

  /// The number of leaves visited so far, and of cores split.
  std::int64_t leaves() const { return leaves_ + cores_.splitCount(); }
  /// The number of cells within patches.
  std::int64_t cells() const { return cells_; }
  std::int64_t work() const { return leaves() + cells(); }
  /// Whether the last search has met so many leaves in vain that it is to be made again with cones.
  bool gaveUp() const { return gave_up_; }

  /// The location of the closest point, with face -1 if none is within `max_distance`. Lengths are
  /// in the unit of the tree.
  Location find(const Vector3& point, double max_distance, const Facing* facing) {
    const bool is_bounded = has_last_ && !facing;
    const Location found = findOnce(point, max_distance, facing);
    if (found.face >= 0 || !is_bounded) {
      return found;
    }
    // On patches that are squeezed to lines, rounding may hide the place of the last search.
    return findOnce(point, max_distance, facing);
  }

 private:
  static constexpr double kDistanceRounding = 1e-15;
  /// A search with a condition on normals ends after this many leaves if it has no cones.
  static constexpr std::int64_t kPatience = 8;
  static constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

  /// The same, in reach of the place that the last search found, if it found one.
  Location findOnce(const Vector3& point, double max_distance, const Facing* facing) {
    gave_up_ = false;
    last_leaf_ = facing && !cones_ ? leaves_ + kPatience : kForever;
    if (facing && cones_) {
      unit_ = facing->direction.normalized();
      reach_ = facing->least_cosine < -1 ? kPi<double> : std::acos(facing->least_cosine);
    }
    facing_ = facing;
    best_ = {};
    best_.from = SearchPoint(point, data_.middle, data_.patches.diagonal());
    best_.tolerance = data_.tolerance;
    // Points at max_distance itself count, in spite of rounding. The range may be shorter than the
    // way that it stands for.
    best_.excess = max_distance * (1 + kDistanceRounding) + 2 * data_.tolerance -
                   (best_.from.isFar() ? (point - data_.middle).norm() : 0);
    if (has_last_ && !facing && !best_.from.isFar()) {
      // The place that the last search found is no closer than the closest one: farther parts need
      // not be looked at. Searches follow each other through space.
      const double distance = (last_ - point).norm();
      const double rounding = kDistanceRounding * (distance + last_.cwiseAbs().maxCoeff());
      best_.excess = std::min(best_.excess, distance + rounding + 2 * data_.tolerance);
    }
    if (!data_.empty()) {
      point_in_boxes_ = data_.inBoxes(point);
      cores_.begin(facing, point_in_boxes_);
      descend();
      if (!gave_up_) {
        cores_.visit();
      }
    }
    cells_ += best_.cells;
    // On a surface without extent, where the tolerance is 0, the bound would leave out the place.
    has_last_ = best_.at.face >= 0 && data_.tolerance > 0;
    if (has_last_) {
      last_ = best_.from.place + best_.offset;
    }
    return best_.at;
  }

  /// Walks down the tree. At each node the boxes that are likely to be nearest come first.
  void descend() {
    const BoxPoint box_point(best_.from, point_in_boxes_, data_.crowd.has_value());
    NearestFirst open;
    NearestFirst::Entry next = SearchTree::kRoot;
    do {
      if (!(next.key < best_.enough())) {
        continue;
      }
      const TreePart& part = data_.part(next);
      if (!WideTree::isLeaf(next.place)) {
        const WideTree::Node& node = part.nodes[static_cast<std::size_t>(next.place)];
        WideTree::Row squared = box_point.squaredDistances(node);
        const double enough = best_.enough();
        const auto matters = [&](int child) {
          return squared[child] < enough &&
                 !(facing_ && cones_ && child < node.count &&
                   cones_->cannotFace(next, child, point_in_boxes_, unit_, reach_));
        };
        unsigned bits = WideTree::children(node, matters);
        if (node.closer >= 0) {
          bits = lookCloser(data_.closerBoxes(node), bits, squared);
        }
        open.add(node, squared, box_point.nearness(node, squared), bits, next.part);
        continue;
      }
      const std::int32_t leaf = WideTree::leaf(next.place);
      const SearchLeaf& found = part.leaves[static_cast<std::size_t>(leaf)];
      const double squared = squaredDistanceTo(found.box, best_.from, point_in_boxes_);
      if (squared < best_.enough()) {
        if (leaves_ == last_leaf_) {
          gave_up_ = true;
          return;
        }
        ++leaves_;
        if (found.piece.isCore()) {
          cores_.putOff(found.piece, squared);
        } else {
          closestOnPatch(cache_.patch(part, next), found.foot_bound, facing_, best_);
        }
      }
    } while (open.take(next));
  }

  /// Raises the bounds of the children of a node whose bits are set and that have closer boxes.
  /// Returns the bits of those that still matter.
  unsigned lookCloser(const CloserBoxes& closer, unsigned bits, WideTree::Row& squared) const {
    for (int child = 0; child < WideTree::kWidth; ++child) {
      if ((bits & closer.children) >> child & 1) {
        const double bound = squaredDistanceTo(closer.boxes[child], best_.from, point_in_boxes_);
        squared[child] = std::max(squared[child], roundedDown(bound));
        bits &= ~(static_cast<unsigned>(!(bound < best_.enough())) << child);
      }
    }
    return bits;
  }

  const SearchTree& data_;
  const NormalCones* cones_;
  PatchCache cache_;
  std::int64_t leaves_ = 0, last_leaf_ = kForever, cells_ = 0;
  bool gave_up_ = false;
  Vector3 unit_;      // the direction in which the surface must face
  double reach_ = 0;  // the largest angle between them
  Vector3 point_in_boxes_;
  bool has_last_ = false;
  Vector3 last_;  // the place that the last search found, if it found one
  const Facing* facing_ = nullptr;
  ClosestSoFar best_;
  ClosestOnCores cores_;
};

/// A call of SurfaceSearch::closest().
class ClosestRows {
 public:
  /// Searches for the locations `at`, which get as many rows.
  ClosestRows(const SearchTree& data, const PointRows& points, const ClosestOptions& options,
              int threads, std::vector<Location>& at)
      : data_(data),
        points_(points),
        options_(options),
        threads_(threads),
        // An angle of pi accepts all normals; a cosine of -2 keeps rounding from excluding any.
        least_cosine_(options.max_angle >= kNearlyPi ? kAnyCosine : std::cos(options.max_angle)),
        at_(at) {
    at_.clear();
    resizeInParts(at_, static_cast<std::size_t>(points.rows()));
  }

  void run() {
    data_.prepare(at_.size(), threads_);
    Rows open = spatialOrder(points_, threads_);
    search(open, Condition::none, nullptr);
    if (options_.facing.rows() == 0) {
      return;
    }
    // The closest point of all is also the closest of those that face the right way, if it does.
    removeDone(open);
    // A search that finds nothing that faces the right way would look at the whole surface. It is
    // made again, with the help of cones.
    open = search(std::move(open), Condition::facing, nullptr);
    if (!open.empty()) {
      search(std::move(open), Condition::facing, &data_.normalCones(threads_));
    }
  }

  std::int64_t leaves() const { return leaves_; }
  std::int64_t cells() const { return cells_; }

 private:
  using Rows = std::vector<std::size_t>;
  enum class Condition { none, facing };

  Facing facing(std::size_t row) const {
    const auto i = static_cast<Eigen::Index>(row);
    return {data_.surface, inUnit(options_.facing.row(i).transpose()), least_cosine_};
  }

  /// Searches for the points of some rows. Returns those whose searches gave up.
  Rows search(Rows open, Condition condition, const NormalCones* cones) {
    Rows gave_up;
    for (std::size_t grain = kRowsPerTask; !open.empty();
         grain = std::max<std::size_t>(grain / kSmaller, 1)) {
      open = searchByTasks(open, grain, condition, cones, gave_up);
    }
    return gave_up;
  }

  /// The same by tasks of about `grain` rows. Appends the rows that gave up, and returns those that
  /// are left to smaller tasks.
  Rows searchByTasks(const Rows& rows, std::size_t grain, Condition condition,
                     const NormalCones* cones, Rows& gave_up) {
    enum class State : char { done, later, in_vain };
    std::vector<State> states(rows.size(), State::later);
    parallelFor(rows.size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
      ClosestSearch search(data_, cones);
      std::int64_t work_passed = 0;
      for (std::size_t i = begin; i < end && (grain == 1 || search.work() < kWorkPerTask); ++i) {
        if (i + kPrefetched < end) {
          prefetch(points_.coeffRef(static_cast<Eigen::Index>(rows[i + kPrefetched]), 0));
        }
        std::optional<Facing> filter;
        if (condition == Condition::facing) {
          filter.emplace(facing(rows[i]));
        }
        const auto row = static_cast<Eigen::Index>(rows[i]);
        at_[rows[i]] =
            search.find(data_.scale * points_.row(row).transpose(),
                        data_.scale * options_.max_distance, filter ? &*filter : nullptr);
        states[i] = search.gaveUp() ? State::in_vain : State::done;
        if (search.work() - work_passed >= kWorkPerPass) {
          InterruptionPoint::pass();
          work_passed = search.work();
        }
      }
      leaves_ += search.leaves();
      cells_ += search.cells();
    });
    Rows later;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (states[i] != State::done) {
        (states[i] == State::later ? later : gave_up).push_back(rows[i]);
      }
    }
    return later;
  }

  /// Leaves the rows for which a place was found whose normal does not meet the condition.
  void removeDone(Rows& rows) const {
    Hits hits;
    hits.at = at_;
    completeHits(data_.surface, hits, threads_);
    const auto isDone = [&](std::size_t row) {
      const Vector3 normal = hits.normal.row(static_cast<Eigen::Index>(row));
      return at_[row].face < 0 || facing(row).accepts(normal);
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), isDone), rows.end());
  }

  const SearchTree& data_;
  const PointRows& points_;
  const ClosestOptions& options_;
  const int threads_;
  const double least_cosine_;
  std::vector<Location>& at_;
  std::atomic<std::int64_t> leaves_{0}, cells_{0};
};

}  // namespace

Hits SurfaceSearch::closest(const PointRows& points, const ClosestOptions& options,
                            int threads) const {
  Hits hits;
  closest(points, options, hits, threads);
  return hits;
}

void SurfaceSearch::closest(const PointRows& points, const ClosestOptions& options, Hits& hits,
                            int threads) const {
  checkThreads(threads);
  const double scale = data_->scale;
  checkFinite(points, "points", scale);
  checkDistance(options.max_distance);
  if (options.facing.rows() > 0) {
    checkRows("facing", options.facing.rows(), points.rows(), "points");
    checkDirections(options.facing, "facing");
  }
  checkAngle(options.max_angle);
  ClosestRows rows(*data_, points, options, threads, hits.at);
  rows.run();
  if (options.leaves) {
    *options.leaves = rows.leaves();
  }
  if (options.cells) {
    *options.cells = rows.cells();
  }
  completeHits(data_->surface, hits, threads);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    hits.distance[row] = (scale * (hits.position.row(row) - points.row(row))).norm() / scale;
  }
}

}  // namespace limitsurf
