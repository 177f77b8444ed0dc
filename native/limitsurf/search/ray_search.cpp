// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "limitsurf/float_rounding.h"
#include "limitsurf/parallel.h"
#include "limitsurf/search/box_queries.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/search/hit_evaluation.h"
#include "limitsurf/search/patch_intersection.h"
#include "limitsurf/search/search_tree.h"

namespace limitsurf {
namespace {

/// Searches for one ray after the other.
class RaySearch {
 public:
  explicit RaySearch(const SearchTree& tree) : data_(tree), cache_(tree) {
    found_.tolerance = tree.tolerance;
  }

  /// The hits between the distances 0 and `max_distance`: the first, or all in order. Lengths are
  /// in the unit of the tree.
  std::vector<RayHit>& find(const Vector3& origin, const Vector3& direction, double max_distance,
                            bool first_only) {
    found_.hits.clear();
    if (data_.tree->empty()) {
      return found_.hits;
    }
    // The ray's origin is moved to the ray's point nearest to the middle of the surface:
    // coordinates are small there, so that neighbouring patches agree to the last digits. The ray
    // begins at the distance `start` from that point.
    Ray ray;
    ray.direction = direction.stableNormalized();
    const Vector3 from_middle = origin - data_.middle;
    const double start = from_middle.dot(ray.direction);
    ray.origin = from_middle - start * ray.direction;
    found_.first_only = first_only;
    found_.from = start;
    found_.nearest = start + max_distance;
    RayFrame frame(ray);
    frame.origin += data_.middle;
    descend(ray, frame);
    for (RayHit& hit : found_.hits) {
      hit.distance = std::max(0., hit.distance - start);
    }
    if (!first_only) {
      sortAndMerge();
    }
    return found_.hits;
  }

 private:
  double margin() const { return found_.tolerance; }
  double start() const { return found_.from - found_.tolerance; }
  double end() const { return found_.nearest; }

  /// Walks down the tree, nearer boxes first. `ray` is in the coordinates of boxes, `frame` in
  /// those of patches.
  void descend(const Ray& ray, const RayFrame& frame) {
    const BoxRay box_ray(ray);
    const float begin = roundedDown(start());
    double end_of_last = end();
    float last = roundedUp(end_of_last);
    NearestFirst open;
    NearestFirst::Entry next{0, begin};
    do {
      if (next.key > end()) {
        continue;
      }
      if (WideTree::isLeaf(next.place)) {
        visitLeaf(WideTree::leaf(next.place), ray, frame);
        continue;
      }
      const WideTree::Node& node = data_.tree->node(next.place);
      if (end() != end_of_last) {
        end_of_last = end();
        last = roundedUp(end_of_last);
      }
      WideTree::Row from, to;
      box_ray.meet(node, begin, last, from, to);
      open.add(node, from, [&](int child) { return from[child] <= to[child]; });
    } while (open.take(next));
  }

  void visitLeaf(std::int32_t leaf, const Ray& ray, const RayFrame& frame) {
    const SearchLeaf& found = data_.leaves[leaf];
    double from = start();
    if (!found.box.meets(ray, margin(), from, end())) {
      return;
    }
    if (found.piece.isCore()) {
      visitCore(found.piece, ray, frame);
    } else {
      intersectPatch(cache_.patch(leaf), frame, found_);
    }
  }

  void visitCore(SurfacePiece core, const Ray& ray, const RayFrame& frame) {
    SurfacePatches::SplitCore split;
    while (true) {
      data_.patches.split(core, split);
      for (const BezierPatch& patch : split.patches) {
        intersectPatch(patch, frame, found_);
      }
      core = split.core;
      double from = start();
      const CoreBox rest(data_.patches.restHull(split), data_.middle);
      if (!rest.meets(ray, margin(), from, end())) {
        return;
      }
      if (data_.patches.coreRadius(core) <= found_.tolerance ||
          core.steps >= SurfacePatches::kMostSteps) {
        touchVertex(core, frame);
        return;
      }
    }
  }

  /// Takes the vertex in place of the rest of a core, if the ray comes close enough to it.
  void touchVertex(const SurfacePiece& core, const RayFrame& frame) {
    const Vector3 vertex = data_.patches.coreVertex(core);
    const Vector3 to_vertex = vertex - frame.origin;
    const double z = to_vertex.dot(frame.direction);
    const double aside = (to_vertex - z * frame.direction).norm();
    if (aside <= found_.tolerance + data_.patches.coreRadius(core) &&
        z >= found_.from - found_.tolerance && z <= found_.nearest) {
      found_.add({z, data_.patches.rectangle(core).at(0, 0), vertex, 1});
    }
  }

  /// Sorts the hits and keeps one of several that are the same: each of two neighbouring patches
  /// finds a hit on their common border, and several cells of a patch may find the same touching
  /// point.
  void sortAndMerge() {
    std::vector<RayHit>& hits = found_.hits;
    std::stable_sort(hits.begin(), hits.end(),
                     [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; });
    double longest = 0;
    for (const RayHit& hit : hits) {
      longest = std::max(longest, hit.slack(found_.tolerance));
    }
    std::vector<RayHit> merged;
    for (const RayHit& hit : hits) {
      bool known = false;
      for (auto other = merged.rbegin();
           !known && other != merged.rend() && hit.distance - other->distance <= 2 * longest;
           ++other) {
        known = (hit.position - other->position).norm() <=
                    hit.slack(found_.tolerance) + other->slack(found_.tolerance) &&
                areNeighbours(hit.at.face, other->at.face);
      }
      if (!known) {
        merged.push_back(hit);
      }
    }
    hits.swap(merged);
  }

  /// Whether the faces have a vertex in common. Sheets that merely lie on each other have none.
  bool areNeighbours(int face, int other) const {
    const std::vector<int>& base = data_.surface.baseFace();
    if (base[face] == base[other]) {
      return true;
    }
    const Span<int> a = data_.surface.mesh().faceVertices(base[face]),
                    b = data_.surface.mesh().faceVertices(base[other]);
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  }

  const SearchTree& data_;
  PatchCache cache_;
  CollectedHits found_;
};

/// Checks the arguments of rayCast() and rayCastAll().
void checkRays(const Points& origins, const Points& directions, double max_distance, double scale,
               int threads) {
  checkThreads(threads);
  checkFinite(origins, "origin", scale);
  checkRows(directions, origins.rows(), "directions");
  checkDirections(directions);
  checkDistance(max_distance);
}

}  // namespace

Hits SurfaceSearch::rayCast(const Points& origins, const Points& directions, double max_distance,
                            int threads) const {
  const double scale = data_->scale;
  checkRays(origins, directions, max_distance, scale, threads);
  std::vector<Location> at(static_cast<std::size_t>(origins.rows()));
  Eigen::VectorXd distance(origins.rows());
  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    RaySearch search(*data_);
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const std::vector<RayHit>& hits =
          search.find(scale * origins.row(row).transpose(), directions.row(row).transpose(),
                      scale * max_distance, true);
      at[i] = hits.empty() ? Location{} : hits[0].at;
      distance[row] =
          hits.empty() ? std::numeric_limits<double>::quiet_NaN() : hits[0].distance / scale;
    }
  });
  Hits result = hitsAt(data_->surface, std::move(at), threads);
  result.distance = std::move(distance);
  return result;
}

RayHits SurfaceSearch::rayCastAll(const Points& origins, const Points& directions,
                                  double max_distance, int threads) const {
  const double scale = data_->scale;
  checkRays(origins, directions, max_distance, scale, threads);
  const std::size_t rays = static_cast<std::size_t>(origins.rows());
  std::vector<std::vector<RayHit>> hits(rays);
  parallelFor(rays, kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    RaySearch search(*data_);
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      hits[i] = search.find(scale * origins.row(row).transpose(), directions.row(row).transpose(),
                            scale * max_distance, false);
    }
  });
  RayHits result;
  result.offsets.push_back(0);
  std::vector<Location> at;
  std::vector<double> distance;
  for (const std::vector<RayHit>& of_ray : hits) {
    for (const RayHit& hit : of_ray) {
      at.push_back(hit.at);
      distance.push_back(hit.distance / scale);
    }
    result.offsets.push_back(static_cast<std::int64_t>(at.size()));
  }
  static_cast<Hits&>(result) = hitsAt(data_->surface, std::move(at), threads);
  result.distance =
      Eigen::Map<Eigen::VectorXd>(distance.data(), static_cast<Eigen::Index>(distance.size()));
  return result;
}

}  // namespace limitsurf
