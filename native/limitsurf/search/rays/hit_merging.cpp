// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rays/hit_merging.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// Whether the faces have a vertex in common. Sheets that merely lie on each other have none.
bool areNeighbours(const LimitSurface& surface, int face, int other) {
  const std::vector<int>& base = surface.baseFace();
  if (base[face] == base[other]) {
    return true;
  }
  const Span<int> a = surface.mesh().faceVertices(base[face]),
                  b = surface.mesh().faceVertices(base[other]);
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

}  // namespace

void mergeHits(const LimitSurface& surface, double tolerance, std::vector<RayHit>& hits) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; });
  double longest = 0;
  for (const RayHit& hit : hits) {
    longest = std::max(longest, hit.slack(tolerance));
  }
  std::vector<RayHit> merged;
  for (const RayHit& hit : hits) {
    bool known = false;
    for (auto other = merged.rbegin();
         !known && other != merged.rend() && hit.distance - other->distance <= 2 * longest;
         ++other) {
      known = (hit.position - other->position).norm() <=
                  hit.slack(tolerance) + other->slack(tolerance) &&
              areNeighbours(surface, hit.at.face, other->at.face);
    }
    if (!known) {
      merged.push_back(hit);
    }
  }
  hits.swap(merged);
}

}  // namespace limitsurf
