// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/nearest_sources.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "limitsurf/geodesic/unfolding.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A distance is replaced by one that is shorter by more than this share, at first.
constexpr double kLeastShortening = 1e-6;
/// A vertex that has passed on a distance so many times does so again only if it has become shorter
/// by twice the share of the time before. Distances approach their limits slowly where triangles
/// are long and thin, and where they are well shaped, no distance is passed on more than ten times.
constexpr int kUsualTimes = 24;

/// The distance below which one that has been passed on so many times is replaced.
double replaceable(double distance, int times) {
  const int more = std::max(0, times - kUsualTimes);
  return distance * (1 - std::min(1., std::ldexp(kLeastShortening, more)));
}
/// The number of steps, which take some microseconds each, between two interruption points, and
/// between two reports of progress.
constexpr std::size_t kStepsPerPass = std::size_t{1} << 12, kStepsPerReport = std::size_t{1} << 16;

}  // namespace

/// Ties are broken by numbers, so that the result does not depend on the order of the heap.
bool NearestSources::Waiting::operator>(const Waiting& other) const {
  return std::tie(distance, source, vertex) > std::tie(other.distance, other.source, other.vertex);
}

NearestSources::NearestSources(const GeodesicMesh& mesh, const std::vector<MeshPlace>& sources,
                               const std::vector<int>& most, const Progress& progress, double reach)
    : mesh_(mesh),
      sources_(sources),
      reach_(reach),
      first_(most.size() + 1, 0),
      counts_(most.size()),
      finals_(most.size()) {
  for (std::size_t vertex = 0; vertex < most.size(); ++vertex) {
    first_[vertex + 1] = first_[vertex] + 2 * static_cast<std::size_t>(most[vertex]);
  }
  resizeInParts(entries_, first_.back());
  for (std::size_t source = 0; source < sources.size(); ++source) {
    for (const int vertex : mesh.triangle(sources[source].triangle)) {
      offer(vertex, static_cast<int>(source),
            (sources[source].position - mesh.position(vertex)).norm(),
            findEntry(vertex, static_cast<int>(source)));
    }
  }
  spread(progress);
  counts_ = finals_;
}

NearestSources::Entry* NearestSources::findEntry(int vertex, int source) {
  return const_cast<Entry*>(std::as_const(*this).findEntry(vertex, source));
}

const NearestSources::Entry* NearestSources::findEntry(int vertex, int source) const {
  const Entry* entry = entries_.data() + first_[vertex];
  for (const Entry* end = entry + counts_[vertex]; entry != end; ++entry) {
    if (entry->source == source) {
      return entry;
    }
  }
  return nullptr;
}

/// Offers a vertex a distance, which it takes if it does not know a shorter one; `entry` is what it
/// knows. With twice as many entries as it keeps, the largest can be dropped for a smaller one: it
/// is not among the nearest.
void NearestSources::offer(int vertex, int source, double distance, Entry* entry) {
  if (distance > reach_) {
    return;
  }
  if (!entry) {
    if (finals_[vertex] == most(vertex)) {
      return;
    }
    Entry* const first = entries_.data() + first_[vertex];
    if (counts_[vertex] < room(vertex)) {
      entry = first + counts_[vertex]++;
    } else {
      entry =
          std::max_element(first + finals_[vertex], first + room(vertex),
                           [](const Entry& a, const Entry& b) { return a.distance < b.distance; });
      if (entry->distance <= distance) {
        return;
      }
    }
    *entry = {source, 0, distance};
  } else if (distance < replaceable(entry->distance, entry->times)) {
    entry->distance = distance;
  } else {
    return;
  }
  reserveMore(heap_, 1);
  heap_.push_back({distance, vertex, source});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void NearestSources::passOn(int vertex, int source, double distance) {
  const Span<GeodesicMesh::Neighbor> neighbors = mesh_.neighborsAt(vertex);
  known_.resize(neighbors.size());
  offered_.resize(neighbors.size());
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    known_[i] = findEntry(neighbors[i].vertex, source);
    offered_[i] = distance + neighbors[i].distance;
  }
  for (const GeodesicMesh::Wedge& wedge : mesh_.wedgesAt(vertex)) {
    const double ab = neighbors[wedge.b].distance, ac = neighbors[wedge.c].distance;
    if (known_[wedge.c]) {
      const double across =
          unfoldedDistance(distance, known_[wedge.c]->distance, {ac, ab, wedge.distance});
      offered_[wedge.b] = std::min(offered_[wedge.b], across);
    }
    if (known_[wedge.b]) {
      const double across =
          unfoldedDistance(distance, known_[wedge.b]->distance, {ab, ac, wedge.distance});
      offered_[wedge.c] = std::min(offered_[wedge.c], across);
    }
  }
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    // One that is listed twice may know the source by now.
    Entry* const entry = known_[i] ? known_[i] : findEntry(neighbors[i].vertex, source);
    offer(neighbors[i].vertex, source, offered_[i], entry);
  }
}

void NearestSources::spread(const Progress& progress) {
  double all = 0;
  for (int vertex = 0; vertex < mesh_.vertexCount(); ++vertex) {
    all += static_cast<double>(std::min(most(vertex), sources_.size()));
  }
  std::size_t steps = 0, accepted = 0;
  while (!heap_.empty()) {
    if (++steps % kStepsPerPass == 0) {
      InterruptionPoint::pass();
    }
    if (progress && steps % kStepsPerReport == 0) {
      progress(std::min(1., static_cast<double>(accepted) / all));
    }
    const Waiting next = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    Entry* entry = findEntry(next.vertex, next.source);
    if (!entry || entry->distance != next.distance) {
      continue;  // a shorter one was found meanwhile
    }
    Entry* const end = entries_.data() + first_[next.vertex] + finals_[next.vertex];
    if (entry >= end) {
      if (finals_[next.vertex] == most(next.vertex)) {
        continue;
      }
      std::swap(*entry, *end);
      entry = end;
      ++finals_[next.vertex];
      ++accepted;
    }
    ++entry->times;
    ++times_passed_on_;
    passOn(next.vertex, next.source, next.distance);
  }
  heap_ = {};
}

/// The distance of a vertex from a source. Where the vertex does not keep the source, because
/// others are nearer, it is what the vertex would learn from its neighbours that do.
double NearestSources::distanceTo(int vertex, int source) const {
  if (const Entry* known = findEntry(vertex, source)) {
    return known->distance;
  }
  const Span<GeodesicMesh::Neighbor> neighbors = mesh_.neighborsAt(vertex);
  double distance = std::numeric_limits<double>::infinity();
  for (const GeodesicMesh::Wedge& wedge : mesh_.wedgesAt(vertex)) {
    const auto &b = neighbors[wedge.b], &c = neighbors[wedge.c];
    const Entry *at_b = findEntry(b.vertex, source), *at_c = findEntry(c.vertex, source);
    if (at_b && at_c) {
      const TriangleSides sides{wedge.distance, b.distance, c.distance};
      distance = std::min(distance, unfoldedDistance(at_b->distance, at_c->distance, sides));
    }
  }
  return distance;
}

void NearestSources::find(const MeshPlace& place, std::vector<Entry>& found) const {
  found.clear();
  const std::array<int, 3>& triangle = mesh_.triangle(place.triangle);
  std::array<double, 3> side{}, radius{};
  for (int k = 0; k < 3; ++k) {
    side[k] = mesh_.distance(triangle[k], triangle[(k + 1) % 3]);
    radius[k] = (place.position - mesh_.position(triangle[k])).norm();
  }
  for (int k = 0; k < 3; ++k) {
    for (const Entry& entry : at(triangle[k])) {
      const bool is_new = std::none_of(found.begin(), found.end(), [&](const Entry& other) {
        return other.source == entry.source;
      });
      if (!is_new) {
        continue;
      }
      const MeshPlace& source = sources_[entry.source];
      double distance = std::numeric_limits<double>::infinity();
      if (source.triangle == place.triangle) {
        distance = (source.position - place.position).norm();
      } else {
        std::array<double, 3> to;
        for (int i = 0; i < 3; ++i) {
          to[i] = distanceTo(triangle[i], entry.source);
          distance = std::min(distance, to[i] + radius[i]);
        }
        for (int i = 0; i < 3; ++i) {
          const int next = (i + 1) % 3;
          if (std::isfinite(to[i]) && std::isfinite(to[next])) {
            distance = std::min(
                distance, unfoldedDistance(to[i], to[next], {side[i], radius[i], radius[next]}));
          }
        }
      }
      found.push_back({entry.source, 0, distance});
    }
  }
}

}  // namespace limitsurf
