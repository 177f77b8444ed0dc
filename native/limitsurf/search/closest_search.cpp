// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/pi.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/search/box_queries.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/search/closest_on_patch.h"
#include "limitsurf/search/hit_evaluation.h"
#include "limitsurf/search/normal_cones.h"
#include "limitsurf/search/search_tree.h"
#include "limitsurf/search/spatial_order.h"

namespace limitsurf {
namespace {

/// A direction in a unit of its own, a power of two, so that its square can be formed.
Vector3 inUnit(const Vector3& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  return {std::scalbn(direction[0], -std::ilogb(largest)),
          std::scalbn(direction[1], -std::ilogb(largest)),
          std::scalbn(direction[2], -std::ilogb(largest))};
}

/// Most rows look at a few leaves, but among sheets that lie on each other at hundreds: so many
/// take some milliseconds.
constexpr std::int64_t kLeavesPerPass = 1024;
/// Points are fetched so many searches ahead: in the order of searches they are scattered.
constexpr std::size_t kPrefetched = 4;
/// Angles from here on count as pi, and then no cosine is too small.
constexpr double kNearlyPi = kPi<double> - 1e-13, kAnyCosine = -2;

/// The searching point as it is seen from an extraordinary vertex.
struct SeenFromVertex {
  SeenFromVertex(const SearchPoint& from, const Vector3& vertex, const Eigen::Matrix3d& frame) {
    const Vector3 offset = vertex - from.place;
    way = from.away - offset;
    squared = offset.dot(offset - 2 * from.away);
    turned = frame * way;
    aside = std::hypot(turned[0], turned[1]);
  }

  Vector3 way;     ///< from the vertex to the point
  Vector3 turned;  ///< the same along the axes of the ring
  double squared;  ///< the vertex's squared distance, less the square of the range
  double aside;    ///< the distance of the point from the ring's last axis
};

/// Searches for one point after the other.
class ClosestSearch {
 public:
  /// With `cones`, subtrees are left out whose normals do not meet the condition. Results are the
  /// same to the last bit.
  explicit ClosestSearch(const SearchTree& data, const NormalCones* cones = nullptr)
      : data_(data), cones_(cones), cache_(data) {}

  /// The number of leaves visited so far, and of cores split.
  std::int64_t leaves() const { return leaves_; }
  /// Whether the last search has met so many leaves in vain that it is to be made again with cones.
  bool gaveUp() const { return gave_up_; }

  /// The location of the closest point, with face -1 if none is within `max_distance`. Lengths are
  /// in the unit of the tree.
  Location find(const Vector3& point, double max_distance, const Facing* facing) {
    gave_up_ = false;
    open_.clear();
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
    if (!data_.tree->empty()) {
      point_in_boxes_ = data_.inBoxes(point);
      descend();
      if (!gave_up_) {
        visitCores();
      }
    }
    return best_.at;
  }

 private:
  static constexpr double kDistanceRounding = 1e-15;
  /// A search with a condition on normals ends after this many leaves if it has no cones.
  static constexpr std::int64_t kPatience = 8;
  /// After so many steps a core asks what is known of all cores around its vertex. Few searches
  /// come so far.
  static constexpr int kManySteps = 8;
  static constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

  /// A lower bound of the squared distance of a box, less the square of the range.
  template <typename Real>
  double squaredDistance(const OrientedBox<Real>& box) const {
    return best_.from.isFar() ? box.squaredDistanceLess(best_.from.away)
                              : box.squaredDistance(point_in_boxes_);
  }

  /// Walks down the tree, nearer boxes first.
  void descend() {
    const BoxPoint box_point(best_.from, point_in_boxes_);
    NearestFirst open;
    NearestFirst::Entry next{0, -std::numeric_limits<float>::infinity()};
    do {
      if (!(next.key < best_.enough())) {
        continue;
      }
      if (!WideTree::isLeaf(next.place)) {
        const WideTree::Node& node = data_.tree->node(next.place);
        const WideTree::Row squared = box_point.squaredDistances(node);
        const double enough = best_.enough();
        open.add(node, squared, [&](int child) {
          return squared[child] < enough &&
                 !(facing_ && cones_ && child < node.count &&
                   cones_->ofChild(next.place, child).isBeyond(unit_, reach_));
        });
        continue;
      }
      const std::int32_t leaf = WideTree::leaf(next.place);
      const double squared = squaredDistance(data_.leaves[leaf].box);
      if (squared < best_.enough()) {
        if (leaves_ == last_leaf_) {
          gave_up_ = true;
          return;
        }
        ++leaves_;
        visitLeaf(leaf, squared);
      }
    } while (open.take(next));
  }

  void visitLeaf(std::int32_t leaf, double squared) {
    const SearchLeaf& found = data_.leaves[leaf];
    if (found.piece.isCore()) {
      putOff(found.piece, squared);
    } else {
      closestOnPatch(cache_.patch(leaf), found.foot_bound, facing_, best_);
    }
  }

  /// A core that is left for later, or what is left of one.
  struct OpenCore {
    double squared;  ///< a lower bound of its squared distance
    std::size_t split;
    SurfacePiece core;

    bool operator<(const OpenCore& other) const {  // the nearest one becomes the top of a heap
      return squared != other.squared ? squared > other.squared : split > other.split;
    }
  };

  /// Cores are split after all patches have been searched. The vertex of a core is a first guess,
  /// and if it stayed the best one while its own core is split, no bound of the rest, which always
  /// contains the vertex, would end that.
  void putOff(const SurfacePiece& core, double squared) {
    if (isLikeTheFirst(core)) {
      return;
    }
    if (!facing_) {
      best_.offer(data_.patches.coreVertex(core) - best_.from.place,
                  data_.patches.rectangle(core).at(0, 0));
    }
    if (open_.size() == splits_.size()) {
      splits_.emplace_back(new SurfacePatches::SplitCore);
    }
    open_.push_back({squared, open_.size(), core});
  }

  /// Splits the cores that were put off, always the nearest one first.
  void visitCores() {
    std::make_heap(open_.begin(), open_.end());
    while (!open_.empty() && open_.front().squared < best_.enough()) {
      std::pop_heap(open_.begin(), open_.end());
      const OpenCore next = open_.back();
      open_.pop_back();
      const int ring = data_.patches.ringOf(next.core);
      if (data_.rings.isLarge(ring)) {
        visitRing(ring, next.core);
        continue;
      }
      SurfacePiece core = next.core;
      skipLevels(ring, core);
      SurfacePatches::SplitCore& split = *splits_[next.split];
      if (isSmall(core)) {
        offerVertex(core, data_.patches.coreVertex(core));
        continue;
      }
      visitParts(core, split);
      const CoreBox rest(data_.patches.restHull(split), data_.middle);
      const double squared = squaredDistance(rest);
      if (!(squared < best_.enough())) {
        continue;
      }
      open_.push_back({std::max(squared, next.squared), next.split, split.core});
      std::push_heap(open_.begin(), open_.end());
    }
    open_.clear();
  }

  bool isSmall(const SurfacePiece& core) const {
    return data_.patches.coreRadius(core) <= data_.tolerance ||
           core.steps >= SurfacePatches::kMostSteps;
  }

  /// Splits a core and searches its patches.
  void visitParts(const SurfacePiece& core, SurfacePatches::SplitCore& split) {
    data_.patches.split(core, split);
    ++leaves_;
    for (const BezierPatch& patch : split.patches) {
      closestOnPatch(patch, {}, facing_, best_);
    }
  }

  SeenFromVertex seenFrom(int ring, const SurfacePiece& core) const {
    return {best_.from, data_.patches.coreVertex(core), data_.patches.ringFrame(ring)};
  }

  /// Whether the point lies on the axis of a ring with the symmetry of a regular polygon, and the
  /// core is another than the first one, to which it is as near.
  bool isLikeTheFirst(const SurfacePiece& core) const {
    const int ring = data_.patches.ringOf(core);
    return !facing_ && core.tile != data_.rings.firstTile(ring) &&
           data_.patches.ringLevel(core) >= data_.rings.firstLevel(ring) &&
           data_.rings.isSymmetric(ring, seenFrom(ring, core).aside);
  }

  /// Takes the steps of a core that cannot lead to a closer point.
  void skipLevels(int ring, SurfacePiece& core) const {
    const int level = data_.patches.ringLevel(core);
    if (core.steps < kManySteps || level < data_.rings.firstLevel(ring)) {
      return;
    }
    const RingLevel* at = &data_.rings.level(ring, level);
    const SeenFromVertex seen = seenFrom(ring, core);
    while (!isSmall(core) && cannotMatter(*at, seen)) {
      ++core.steps;
      at = &data_.rings.level(ring, data_.patches.ringLevel(core));
    }
  }

  /// Whether no point between the cores of a level and those of the next can be closer.
  bool cannotMatter(const RingLevel& level, const SeenFromVertex& seen) const {
    return seen.squared + level.bounds.squaredDistanceLess(seen.turned[2], seen.aside) >=
           best_.enough();
  }

  /// Searches all cores around a vertex, level by level.
  void visitRing(int ring, SurfacePiece core) {
    const SeenFromVertex seen = seenFrom(ring, core);
    const bool is_symmetric = !facing_ && data_.rings.isSymmetric(ring, seen.aside);
    for (; !isSmall(core); ++core.steps) {
      const int number = data_.patches.ringLevel(core);
      const RingLevel& level = data_.rings.level(ring, number);
      ++leaves_;
      if (!cannotMatter(level, seen)) {
        if (is_symmetric) {
          visitParts(core, ring_split_);
        } else {
          visitSectors(ring, number, seen);
        }
      }
      if (seen.squared + level.restSquaredDistanceLess(seen.turned) >= best_.enough()) {
        return;
      }
    }
    offerVertex(core, data_.patches.coreVertex(core));
  }

  /// Searches the patches between the cores of a level and those of the next, nearer ones first.
  void visitSectors(int ring, int level, const SeenFromVertex& seen) {
    const SectorTree& sectors = data_.rings.sectors(ring, level);
    struct Entry {
      int node;
      double squared;
    };
    const auto entry = [&](int node) -> Entry {
      return {node, seen.squared + sectors.box(node).squaredDistanceLess(seen.way)};
    };
    Entry open[SectorTree::kMostOpen];
    int height = 0;
    open[height++] = entry(SectorTree::kRoot);
    while (height > 0) {
      const Entry next = open[--height];
      if (!(next.squared < best_.enough())) {
        continue;
      }
      if (sectors.isLeaf(next.node)) {
        visitParts(data_.rings.core(ring, sectors.core(next.node), level), ring_split_);
        continue;
      }
      const int child = SectorTree::child(next.node);
      open[height] = entry(child);
      open[height + 1] = entry(child + 1);
      if (open[height].squared < open[height + 1].squared) {
        std::swap(open[height], open[height + 1]);
      }
      height += 2;
    }
  }

  /// Offers the vertex in place of the rest of a core, which is smaller than the tolerance.
  void offerVertex(const SurfacePiece& core, const Vector3& vertex) {
    const Location at = data_.patches.rectangle(core).at(0, 0);
    if (facing_ && !facing_->accepts(at)) {
      return;
    }
    best_.offer(vertex - best_.from.place, at);
  }

  const SearchTree& data_;
  const NormalCones* cones_;
  PatchCache cache_;
  std::int64_t leaves_ = 0, last_leaf_ = kForever;
  bool gave_up_ = false;
  Vector3 unit_;      // the direction in which the surface must face
  double reach_ = 0;  // the largest angle between them
  Vector3 point_in_boxes_;
  const Facing* facing_ = nullptr;
  ClosestSoFar best_;
  std::vector<OpenCore> open_;
  std::vector<std::unique_ptr<SurfacePatches::SplitCore>> splits_;  // of open cores
  SurfacePatches::SplitCore ring_split_;
};

}  // namespace

Hits SurfaceSearch::closest(const Points& points, const ClosestOptions& options,
                            int threads) const {
  checkThreads(threads);
  const double scale = data_->scale;
  checkFinite(points, "point", scale);
  checkDistance(options.max_distance);
  const bool facing = options.facing.rows() > 0;
  if (facing) {
    checkRows(options.facing, points.rows(), "facing");
    checkDirections(options.facing);
  }
  checkAngle(options.max_angle);
  // An angle of pi accepts all normals; a cosine of -2 keeps rounding from excluding any.
  const double least_cosine =
      options.max_angle >= kNearlyPi ? kAnyCosine : std::cos(options.max_angle);
  std::vector<Location> at(static_cast<std::size_t>(points.rows()));
  // A search that finds nothing that faces the right way would look at the whole surface. It is
  // made again, with the help of cones.
  std::vector<std::size_t> open = spatialOrder(points, threads);
  std::atomic<std::int64_t> leaves{0};
  const auto searchOpen = [&](const NormalCones* cones) {
    std::vector<char> gave_up(open.size(), 0);
    parallelFor(open.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
      ClosestSearch search(*data_, cones);
      std::int64_t leaves_passed = 0;
      for (std::size_t i = begin; i < end; ++i) {
        if (i + kPrefetched < end) {
          prefetch(points.coeffRef(static_cast<Eigen::Index>(open[i + kPrefetched]), 0));
        }
        const auto row = static_cast<Eigen::Index>(open[i]);
        std::optional<Facing> filter;
        if (facing) {
          filter.emplace(
              Facing{data_->surface, inUnit(options.facing.row(row).transpose()), least_cosine});
        }
        at[open[i]] = search.find(scale * points.row(row).transpose(), scale * options.max_distance,
                                  filter ? &*filter : nullptr);
        gave_up[i] = search.gaveUp();
        if (search.leaves() - leaves_passed >= kLeavesPerPass) {
          InterruptionPoint::pass();
          leaves_passed = search.leaves();
        }
      }
      leaves += search.leaves();
    });
    std::vector<std::size_t> still_open;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (gave_up[i]) {
        still_open.push_back(open[i]);
      }
    }
    open.swap(still_open);
  };
  searchOpen(nullptr);
  if (!open.empty()) {
    searchOpen(&data_->normalCones(threads));
  }
  if (options.leaves) {
    *options.leaves = leaves;
  }
  Hits hits = hitsAt(data_->surface, std::move(at), threads);
  hits.distance.resize(points.rows());
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    hits.distance[row] = (scale * (hits.position.row(row) - points.row(row))).norm() / scale;
  }
  return hits;
}

}  // namespace limitsurf
