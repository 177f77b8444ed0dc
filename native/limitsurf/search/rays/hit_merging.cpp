// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/hit_merging.h"

#include <algorithm>
#include <cstddef>
#include <unordered_map>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// The hits that are kept, in the order of their distances.
class MergedHits {
 public:
  MergedHits(const LimitSurface& surface, double tolerance, double longest_slack)
      : surface_(surface), tolerance_(tolerance), reach_(2 * longest_slack) {}

  /// Keeps a hit unless a neighbouring face has the same one.
  void add(const RayHit& hit) {
    if (!isKnown(hit)) {
      kept_.push_back(hit);
    }
  }
  std::vector<RayHit>& hits() { return kept_; }

 private:
  /// So many hits are compared with one by one. If there are more within reach, as in a stack of
  /// sheets, those on neighbouring faces are looked up by the vertices of faces with few of them.
  static constexpr std::ptrdiff_t kFewHits = 16;
  static constexpr std::size_t kFewVertices = 8;

  bool isKnown(const RayHit& hit) {
    const bool is_on_large_face = vertices(hit.at.face).size() > kFewVertices;
    for (auto other = kept_.rbegin(); other != kept_.rend() && isWithinReach(*other, hit);
         ++other) {
      if (other - kept_.rbegin() == kFewHits && !is_on_large_face) {
        return isKnownNearby(hit);
      }
      if (isSame(*other, hit)) {
        return true;
      }
    }
    return false;
  }

  bool isKnownNearby(const RayHit& hit) {
    for (; listed_ < kept_.size(); ++listed_) {
      const Span<int> at = vertices(kept_[listed_].at.face);
      if (at.size() > kFewVertices) {
        on_large_faces_.push_back(listed_);
        continue;
      }
      for (const int vertex : at) {
        at_vertex_[vertex].push_back(listed_);
      }
    }
    const Span<int> at = vertices(hit.at.face);
    return isKnownAmong(on_large_faces_, hit) || std::any_of(at.begin(), at.end(), [&](int vertex) {
             return isKnownAmong(at_vertex_[vertex], hit);
           });
  }

  bool isKnownAmong(const std::vector<std::size_t>& places, const RayHit& hit) const {
    for (auto place = places.rbegin(); place != places.rend() && isWithinReach(kept_[*place], hit);
         ++place) {
      if (isSame(kept_[*place], hit)) {
        return true;
      }
    }
    return false;
  }

  bool isWithinReach(const RayHit& before, const RayHit& hit) const {
    return hit.distance - before.distance <= reach_;
  }
  bool isSame(const RayHit& a, const RayHit& b) const {
    return (a.position - b.position).norm() <= a.slack(tolerance_) + b.slack(tolerance_) &&
           areNeighbours(a.at.face, b.at.face);
  }

  Span<int> vertices(int face) const {
    return surface_.mesh().faceVertices(surface_.baseFace()[face]);
  }
  /// Whether the faces have a vertex in common. Sheets that merely lie on each other have none.
  bool areNeighbours(int face, int other) const {
    const std::vector<int>& base = surface_.baseFace();
    if (base[face] == base[other]) {
      return true;
    }
    const Span<int> a = vertices(face), b = vertices(other);
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  }

  const LimitSurface& surface_;
  const double tolerance_, reach_;
  std::vector<RayHit> kept_;
  std::size_t listed_ = 0;  // so many of them are in these lists
  std::unordered_map<int, std::vector<std::size_t>> at_vertex_;
  std::vector<std::size_t> on_large_faces_;
};

}  // namespace

void mergeHits(const LimitSurface& surface, double tolerance, std::vector<RayHit>& hits) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; });
  double longest = 0;
  for (const RayHit& hit : hits) {
    longest = std::max(longest, hit.slack(tolerance));
  }
  MergedHits merged(surface, tolerance, longest);
  InterruptionStride stride;
  for (const RayHit& hit : hits) {
    stride.step();
    merged.add(hit);
  }
  hits.swap(merged.hits());
}

}  // namespace limitsurf
