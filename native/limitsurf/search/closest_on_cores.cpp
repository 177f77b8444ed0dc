// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/closest_on_cores.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limitsurf/search/rings/vertex_minimum.h"

namespace limitsurf {
namespace {

/// More than the relative rounding of a difference of squared distances.
constexpr double kRounding = 1e-15;
/// Around the tip of a cone, the normal depends on the direction in which a place lies. Except
/// around u = v = 0, (u, v) has too few digits to tell such directions apart on cores whose sides
/// are shorter than this part of a face.
constexpr double kLeastWidth = 0x1p-48;

}  // namespace

/// The searching point as it is seen from an extraordinary vertex.
struct ClosestOnCores::SeenFromVertex {
  SeenFromVertex(const SearchPoint& from, const Vector3& vertex, const Eigen::Matrix3d& frame) {
    const Vector3 offset = vertex - from.place;
    way = from.away - offset;
    squared = offset.dot(offset - 2 * from.away) -
              kRounding * offset.norm() * (offset.norm() + 2 * from.away.norm());
    turned = frame * way;
    aside = std::hypot(turned[0], turned[1]);
  }

  Vector3 way;     ///< from the vertex to the point
  Vector3 turned;  ///< the same along the axes of the ring
  /// A lower bound of the vertex's squared distance, less the square of the range.
  double squared;
  double aside;  ///< the distance of the point from the ring's last axis
};

void ClosestOnCores::begin(const Facing* facing, const Vector3& point_in_boxes) {
  facing_ = facing;
  point_in_boxes_ = point_in_boxes;
  open_.clear();
  asked_ring_ = -1;
}

void ClosestOnCores::putOff(const SurfacePiece& core, double squared) {
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

void ClosestOnCores::visit() {
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
    data_.rings.skipLevels(
        core, [&](const SurfacePiece& left) { return isSmall(left); },
        [&](const RingLevel& level) { return cannotMatter(level, seenFrom(ring, core)); });
    SurfacePatches::SplitCore& split = *splits_[next.split];
    if (hasNoFoot(ring, core)) {
      continue;
    }
    if (isSmall(core)) {
      visitLast(core, split);
      continue;
    }
    visitParts(core, split);
    const CoreBox rest(data_.patches.restHull(split), data_.middle);
    const double squared = squaredDistanceTo(rest, best_.from, point_in_boxes_);
    if (!(squared < best_.enough())) {
      continue;
    }
    open_.push_back({std::max(squared, next.squared), next.split, split.core});
    std::push_heap(open_.begin(), open_.end());
  }
}

bool ClosestOnCores::isSmall(const SurfacePiece& core) const {
  return data_.patches.coreRadius(core) <= data_.tolerance ||
         core.steps >= SurfacePatches::kMostSteps || (facing_ && hasTooFewDigits(core));
}

bool ClosestOnCores::hasTooFewDigits(const SurfacePiece& core) const {
  const FaceRectangle on = data_.patches.rectangle(core);
  const Location vertex = on.at(0, 0);
  return (vertex.u > 0 || vertex.v > 0) && on.width() < kLeastWidth;
}

void ClosestOnCores::visitParts(const SurfacePiece& core, SurfacePatches::SplitCore& split) {
  data_.patches.split(core, split);
  ++split_count_;
  for (const BezierPatch& patch : split.patches) {
    closestOnPatch(patch, {}, facing_, best_);
  }
}

void ClosestOnCores::visitLast(const SurfacePiece& core, SurfacePatches::SplitCore& split) {
  offerVertex(core);
  if (facing_) {  // the vertex may have no normal
    const double tolerance = best_.tolerance;
    best_.tolerance = std::max(tolerance, 2 * data_.patches.coreRadius(core));  // all are as close
    visitParts(core, split);
    best_.tolerance = tolerance;
  }
}

void ClosestOnCores::offerVertex(const SurfacePiece& core) {
  const Location at = data_.patches.rectangle(core).at(0, 0);
  const Vector3 offset = data_.patches.coreVertex(core) - best_.from.place;
  if (facing_) {
    const int ring = data_.patches.ringOf(core);
    const Vector3 way = best_.from.away - offset;
    if (!facing_->accepts(at) || !mayHaveMinimum(ring, way) || !isFlatAtVertex(data_, ring, way)) {
      return;
    }
  }
  best_.offer(offset, at);
}

bool ClosestOnCores::hasNoFoot(int ring, const SurfacePiece& core) {
  if (!facing_) {
    return false;
  }
  const Vector3 way = seenFrom(ring, core).way;
  return isNearVertex(data_, core, way) && !mayHaveMinimum(ring, way);
}

bool ClosestOnCores::mayHaveMinimum(int ring, const Vector3& way) {
  if (asked_ring_ != ring) {
    asked_ring_ = ring;
    may_have_minimum_ = mayHaveMinimumNear(data_, ring, way);
  }
  return may_have_minimum_;
}

ClosestOnCores::SeenFromVertex ClosestOnCores::seenFrom(int ring, const SurfacePiece& core) const {
  return {best_.from, data_.patches.coreVertex(core), data_.patches.ringFrame(ring)};
}

bool ClosestOnCores::isLikeTheFirst(const SurfacePiece& core) const {
  const int ring = data_.patches.ringOf(core);
  return !facing_ && core.tile != data_.rings.firstTile(ring) &&
         data_.patches.ringLevel(core) >= data_.rings.firstLevel(ring) &&
         data_.rings.isSymmetric(ring, seenFrom(ring, core).aside);
}

bool ClosestOnCores::cannotMatter(const RingLevel& level, const SeenFromVertex& seen) const {
  return seen.squared + level.bounds.squaredDistanceLess(seen.turned[2], seen.aside) >=
         best_.enough();
}

void ClosestOnCores::visitRing(int ring, SurfacePiece core) {
  const SeenFromVertex seen = seenFrom(ring, core);
  const bool is_symmetric = !facing_ && data_.rings.isSymmetric(ring, seen.aside);
  for (; !isSmall(core); ++core.steps) {
    if (hasNoFoot(ring, core)) {
      return;
    }
    const int number = data_.patches.ringLevel(core);
    const RingLevel& level = data_.rings.level(ring, number);
    ++split_count_;
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
  visitLast(core, ring_split_);
}

void ClosestOnCores::visitSectors(int ring, int level, const SeenFromVertex& seen) {
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

}  // namespace limitsurf
