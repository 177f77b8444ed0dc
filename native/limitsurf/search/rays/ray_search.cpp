// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "limitsurf/float_rounding.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/large_pages.h"
#include "limitsurf/parallel.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/row_check.h"
#include "limitsurf/search/box_queries.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/search/hit_evaluation.h"
#include "limitsurf/search/rays/hit_merging.h"
#include "limitsurf/search/rays/patch_intersection.h"
#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {
namespace {

/// The search for one ray after the other, in steps. Between its steps other rays can make theirs,
/// while the memory that the next step needs is on its way.
class RaySearch {
 public:
  RaySearch(const SearchTree& tree, PatchCache& cache) : data_(tree), cache_(cache) {}

  /// Begins a search for the hits between the distances 0 and `max_distance`: the first, or all.
  /// Lengths are in the unit of the tree, which must not be empty.
  void begin(const Vector3& origin, const Vector3& direction, double max_distance,
             bool first_only) {
    // The ray's origin is moved to the ray's point nearest to the middle of the surface:
    // coordinates are small there, so that neighbouring patches agree to the last digits. The ray
    // begins at the distance `start` from that point.
    ray_.direction = direction.stableNormalized();
    const Vector3 from_middle = origin - data_.middle;
    const double start = from_middle.dot(ray_.direction);
    ray_.origin = from_middle - start * ray_.direction;
    found_.hits.clear();
    const double farthest = kFarthest * data_.patches.diagonal();
    found_.rounding = kRayRounding * std::min(std::abs(start), farthest);
    found_.tolerance = data_.tolerance + found_.rounding;
    found_.first_only = first_only;
    found_.from = start;
    found_.nearest = start + max_distance;
    frame_ = RayFrame(ray_);
    frame_.origin += data_.middle;
    box_ray_ = BoxRay(ray_);
    begin_ = roundedDown(this->start());
    open_.clear();
    next_ = SearchTree::kRoot;
    next_.key = begin_;
    box_met_ = false;
  }

  /// Visits a node, the box of a leaf, or a leaf. Returns false when there is nothing left to do.
  bool step() {
    if (found_.cells >= next_pass_) {
      InterruptionPoint::pass();
      next_pass_ = found_.cells + kCellsPerPass;
    }
    const TreePart& part = data_.part(next_);
    if (!WideTree::isLeaf(next_.place)) {
      const WideTree::Node& node = part.nodes[static_cast<std::size_t>(next_.place)];
      WideTree::Row from;
      unsigned met = box_ray_.meet(node, begin_, roundedUp(end()), from);
      if (node.closer >= 0) {
        met = lookCloser(data_.closerBoxes(node), met, from);
      }
      open_.add(node, from, from, met, next_.part);
      return takeNext();
    }
    const std::int32_t leaf = WideTree::leaf(next_.place);
    const SearchLeaf& found = part.leaves[static_cast<std::size_t>(leaf)];
    if (!box_met_) {
      double from = start();
      if (!found.box.meets(ray_, margin(), from, end())) {
        return takeNext();
      }
      if (!found.piece.isCore()) {
        box_met_ = true;
        PatchCache::expect(part, leaf);
        return true;
      }
      visitCore(found.piece);
      return takeNext();
    }
    box_met_ = false;
    intersectPatch(cache_.patch(part, next_), frame_, found_);
    return takeNext();
  }

  /// What has been found: the first hit, or all in order.
  std::vector<RayHit>& hits() {
    for (RayHit& hit : found_.hits) {
      hit.distance = std::max(0., hit.distance - found_.from);
    }
    if (!found_.first_only) {
      mergeHits(data_.surface, found_.tolerance, found_.hits);
    }
    return found_.hits;
  }

 private:
  /// A direction that was computed as a difference of two points, its length, and the ray's point
  /// nearest to the middle are each rounded by 2^-53 of the distance of the origin. From 1,000
  /// diagonals away, that is half of kSearchError; from farther away no bound is given.
  static constexpr double kRayRounding = 4 * 0x1p-53, kFarthest = 1000;

  /// Hits so many tolerances apart count as one: they are less than kSearchError apart.
  static constexpr double kSameHit = 4;

  /// A ray looks at a few parts of patches, or at millions where it runs along many of them. So
  /// many take about a millisecond.
  static constexpr std::int64_t kCellsPerPass = 4096;

  /// Raises where the ray enters the boxes of those children of a node whose bits are set and that
  /// have closer boxes. Returns the bits of those whose boxes it meets.
  unsigned lookCloser(const CloserBoxes& closer, unsigned bits, WideTree::Row& from) const {
    for (int child = 0; child < WideTree::kWidth; ++child) {
      if (((bits & closer.children) >> child & 1) != 0) {
        double enters = start();
        // Leaves are widened by the margin along their own axes, whose corners may lie outside a
        // box that is widened only once.
        bits &=
            ~(static_cast<unsigned>(!closer.boxes[child].meets(ray_, 2 * margin(), enters, end()))
              << child);
        from[child] = std::max(from[child], roundedDown(enters));
      }
    }
    return bits;
  }

  double margin() const { return found_.tolerance; }
  double start() const { return found_.from - found_.tolerance; }
  double end() const { return found_.nearest; }

  /// Walks on, to the nearest box first.
  bool takeNext() {
    do {
      if (!open_.take(next_)) {
        return false;
      }
    } while (next_.key > end());
    data_.expect(next_);
    return true;
  }

  /// How a ray passes an extraordinary vertex.
  struct Passing {
    double aside;  ///< its distance from the vertex
    double angle;  ///< its angle with the first two axes of the ring
  };
  Passing passing(int ring, const SurfacePiece& core) const {
    const Vector3 to_vertex = data_.patches.coreVertex(core) - frame_.origin;
    const Vector3 across = to_vertex - to_vertex.dot(frame_.direction) * frame_.direction;
    const double sine = data_.patches.ringFrame(ring).row(2).dot(frame_.direction);
    return {across.norm(), std::asin(std::min(1., std::abs(sine)))};
  }

  /// Whether the ray meets nothing between the cores of a level and those of the next.
  bool misses(const RingLevel& level, const Passing& passing) const {
    return level.bounds.distanceFromLine(passing.angle) > passing.aside + margin();
  }

  /// Whether the vertex may stand for the rest of a core: all of it is as near as the tolerance or,
  /// if the ray meets the vertex itself, so near that no other hit there would be another one.
  bool isSmall(const SurfacePiece& core, const Passing& passing) const {
    const double tolerance = found_.tolerance;
    return data_.patches.coreRadius(core) <=
               (passing.aside <= tolerance ? kSameHit * tolerance : tolerance) ||
           core.steps >= SurfacePatches::kMostSteps;
  }

  void visitParts(const SurfacePiece& core, SurfacePatches::SplitCore& split) {
    data_.patches.split(core, split);
    for (const BezierPatch& patch : split.patches) {
      intersectPatch(patch, frame_, found_);
    }
  }

  /// Whether the ray meets the rest of a core.
  bool meetsRest(const SurfacePatches::SplitCore& split) const {
    double from = start();
    return CoreBox(data_.patches.restHull(split), data_.middle).meets(ray_, margin(), from, end());
  }

  void visitCore(SurfacePiece core) {
    const int ring = data_.patches.ringOf(core);
    if (data_.rings.isLarge(ring)) {
      visitRing(ring, core);
      return;
    }
    SurfacePatches::SplitCore split;
    const Passing how = passing(ring, core);
    for (; !isSmall(core, how); ++core.steps) {
      data_.rings.skipLevels(
          core, [&](const SurfacePiece& left) { return isSmall(left, how); },
          [&](const RingLevel& level) { return misses(level, how); });
      if (isSmall(core, how)) {
        break;
      }
      visitParts(core, split);
      if (!meetsRest(split)) {
        return;
      }
    }
    touchVertex(core);
  }

  /// Searches all cores around a vertex, level by level.
  void visitRing(int ring, SurfacePiece core) {
    const Passing how = passing(ring, core);
    const Eigen::Matrix3d frame = data_.patches.ringFrame(ring);
    const Vector3 vertex = data_.patches.coreVertex(core);
    for (; !isSmall(core, how); ++core.steps) {
      const int number = data_.patches.ringLevel(core);
      const RingLevel& level = data_.rings.level(ring, number);
      if (!misses(level, how)) {
        visitSectors(ring, number, vertex);
      }
      double from = start();
      const CoreBox rest({vertex, frame, level.rest_low, level.rest_high}, data_.middle);
      if (!rest.meets(ray_, margin(), from, end())) {
        return;
      }
    }
    touchVertex(core);
  }

  /// Searches the patches between the cores of a level and those of the next.
  void visitSectors(int ring, int level, const Vector3& vertex) {
    const SectorTree& sectors = data_.rings.sectors(ring, level);
    const Ray from_vertex{frame_.origin - vertex, ray_.direction};
    SurfacePatches::SplitCore split;
    int open[SectorTree::kMostOpen];
    int height = 0;
    open[height++] = SectorTree::kRoot;
    while (height > 0) {
      const int node = open[--height];
      double from = start();
      if (!sectors.box(node).meets(from_vertex, margin(), from, end())) {
        continue;
      }
      if (sectors.isLeaf(node)) {
        visitParts(data_.rings.core(ring, sectors.core(node), level), split);
        continue;
      }
      open[height++] = SectorTree::child(node) + 1;
      open[height++] = SectorTree::child(node);
    }
  }

  /// Takes the vertex in place of the rest of a core, if the ray comes close enough to it.
  void touchVertex(const SurfacePiece& core) {
    const Vector3 vertex = data_.patches.coreVertex(core);
    const Vector3 to_vertex = vertex - frame_.origin;
    const double z = to_vertex.dot(frame_.direction);
    const double aside = (to_vertex - z * frame_.direction).norm();
    if (aside <= found_.tolerance + data_.patches.coreRadius(core) &&
        z >= found_.from - found_.tolerance && z <= found_.nearest) {
      found_.add({z, data_.patches.rectangle(core).at(0, 0), vertex, 1});
    }
  }

  const SearchTree& data_;
  PatchCache& cache_;
  Ray ray_;         // in the coordinates of boxes
  RayFrame frame_;  // in those of patches
  BoxRay box_ray_;
  float begin_ = 0;
  NearestFirst open_;
  NearestFirst::Entry next_{};
  bool box_met_ = false;  // whether the ray meets the box of the leaf that comes next
  CollectedHits found_;
  std::int64_t next_pass_ = kCellsPerPass;
};

/// Rays that are searched for at once, step by step in turns. More do not hide more latency.
constexpr std::size_t kRaysAtOnce = 8;

/// Calls found(row, hits) for each ray.
template <typename Found>
void searchRays(const SearchTree& tree, const PointRows& origins, const PointRows& directions,
                double max_distance, bool first_only, int threads, const Found& found) {
  if (tree.empty()) {
    return;
  }
  tree.prepare(static_cast<std::size_t>(origins.rows()), threads);
  parallelFor(static_cast<std::size_t>(origins.rows()), kRowsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                PatchCache cache(tree);
                std::vector<std::unique_ptr<RaySearch>> searches;
                std::size_t rows[kRaysAtOnce];
                std::size_t next = begin;
                const auto start = [&](std::size_t i) {
                  const auto row = static_cast<Eigen::Index>(next);
                  rows[i] = next++;
                  searches[i]->begin(tree.scale * origins.row(row).transpose(),
                                     directions.row(row).transpose(), tree.scale * max_distance,
                                     first_only);
                };
                while (searches.size() < kRaysAtOnce && next < end) {
                  searches.push_back(std::make_unique<RaySearch>(tree, cache));
                  start(searches.size() - 1);
                }
                std::size_t left = searches.size();
                bool idle[kRaysAtOnce] = {};
                while (left > 0) {
                  for (std::size_t i = 0; i < searches.size(); ++i) {
                    if (idle[i] || searches[i]->step()) {
                      continue;
                    }
                    found(rows[i], searches[i]->hits());
                    if (next < end) {
                      start(i);
                    } else {
                      idle[i] = true;
                      --left;
                    }
                  }
                }
              });
}

/// Checks the arguments of rayCast() and rayCastAll().
void checkRays(const PointRows& origins, const PointRows& directions, double max_distance,
               double scale, int threads) {
  checkThreads(threads);
  checkFinite(origins, "origins", scale);
  checkRows("directions", directions.rows(), origins.rows(), "origins");
  checkDirections(directions, "directions");
  checkDistance(max_distance);
}

}  // namespace

Hits SurfaceSearch::rayCast(const PointRows& origins, const PointRows& directions,
                            double max_distance, int threads) const {
  Hits hits;
  rayCast(origins, directions, max_distance, hits, threads);
  return hits;
}

void SurfaceSearch::rayCast(const PointRows& origins, const PointRows& directions,
                            double max_distance, Hits& hits, int threads) const {
  const double scale = data_->scale;
  checkRays(origins, directions, max_distance, scale, threads);
  const auto rows = static_cast<std::size_t>(origins.rows());
  hits.at.clear();
  resizeInParts(hits.at, rows);
  resizeRows(hits.distance, rows);
  hits.distance.setConstant(std::numeric_limits<double>::quiet_NaN());
  searchRays(*data_, origins, directions, max_distance, true, threads,
             [&](std::size_t row, const std::vector<RayHit>& found) {
               if (!found.empty()) {
                 hits.at[row] = found[0].at;
                 hits.distance[static_cast<Eigen::Index>(row)] = found[0].distance / scale;
               }
             });
  completeHits(data_->surface, hits, threads);
}

RayHits SurfaceSearch::rayCastAll(const PointRows& origins, const PointRows& directions,
                                  double max_distance, int threads) const {
  const double scale = data_->scale;
  checkRays(origins, directions, max_distance, scale, threads);
  std::vector<std::vector<RayHit>> hits(static_cast<std::size_t>(origins.rows()));
  searchRays(*data_, origins, directions, max_distance, false, threads,
             [&](std::size_t row, const std::vector<RayHit>& found) { hits[row] = found; });
  RayHits result;
  result.offsets.push_back(0);
  std::vector<double> distance;
  for (const std::vector<RayHit>& of_ray : hits) {
    for (const RayHit& hit : of_ray) {
      result.at.push_back(hit.at);
      distance.push_back(hit.distance / scale);
    }
    result.offsets.push_back(static_cast<std::int64_t>(result.at.size()));
  }
  completeHits(data_->surface, result, threads);
  result.distance =
      Eigen::Map<Eigen::VectorXd>(distance.data(), static_cast<Eigen::Index>(distance.size()));
  return result;
}

}  // namespace limitsurf
