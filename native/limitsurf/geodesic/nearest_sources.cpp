// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/nearest_sources.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "limitsurf/geodesic/unfolding.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A distance is replaced by one that is shorter by more than this share. Among long thin
/// triangles, as around a pole, distances approach their limits over thousands of rounds; what is
/// left of that is far below kGuideDistanceError.
constexpr double kShorter = 1 - 1e-6;
/// The number of steps between two reports of progress.
constexpr std::size_t kStepsPerReport = std::size_t{1} << 16;

}  // namespace

/// Ties are broken by numbers, so that the result does not depend on the order of the heap.
bool NearestSources::Waiting::operator>(const Waiting& other) const {
  return std::tie(distance, source, vertex) > std::tie(other.distance, other.source, other.vertex);
}

NearestSources::NearestSources(const GeodesicMesh& mesh, const std::vector<MeshPlace>& sources,
                               int most, const Progress& progress, double reach)
    : mesh_(mesh),
      sources_(sources),
      most_(static_cast<std::size_t>(most)),
      capacity_(2 * most_),
      reach_(reach),
      entries_(static_cast<std::size_t>(mesh.vertexCount()) * capacity_),
      counts_(static_cast<std::size_t>(mesh.vertexCount())),
      finals_(static_cast<std::size_t>(mesh.vertexCount())) {
  for (std::size_t source = 0; source < sources.size(); ++source) {
    for (const int vertex : mesh.triangle(sources[source].triangle)) {
      offer(vertex, static_cast<int>(source),
            (sources[source].position - mesh.position(vertex)).norm());
    }
  }
  spread(progress);
  counts_ = finals_;
}

NearestSources::Entry* NearestSources::findEntry(int vertex, int source) {
  return const_cast<Entry*>(std::as_const(*this).findEntry(vertex, source));
}

const NearestSources::Entry* NearestSources::findEntry(int vertex, int source) const {
  const Entry* entry = entries_.data() + static_cast<std::size_t>(vertex) * capacity_;
  for (const Entry* end = entry + counts_[vertex]; entry != end; ++entry) {
    if (entry->source == source) {
      return entry;
    }
  }
  return nullptr;
}

/// Offers a vertex a distance, which it takes if it does not know a shorter one. With twice as many
/// entries as it keeps, the largest can be dropped for a smaller one: it is not among the nearest.
void NearestSources::offer(int vertex, int source, double distance) {
  if (distance > reach_) {
    return;
  }
  Entry* entry = findEntry(vertex, source);
  if (!entry) {
    if (finals_[vertex] == most_) {
      return;
    }
    Entry* const first = entries_.data() + static_cast<std::size_t>(vertex) * capacity_;
    if (counts_[vertex] < capacity_) {
      entry = first + counts_[vertex]++;
    } else {
      entry =
          std::max_element(first + finals_[vertex], first + capacity_,
                           [](const Entry& a, const Entry& b) { return a.distance < b.distance; });
      if (entry->distance <= distance) {
        return;
      }
    }
    *entry = {source, distance};
  } else if (distance < entry->distance * kShorter) {
    entry->distance = distance;
  } else {
    return;
  }
  heap_.push_back({distance, vertex, source});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void NearestSources::passOn(int vertex, int source, double distance) {
  for (const int number : mesh_.trianglesAt(vertex)) {
    const std::array<int, 3>& triangle = mesh_.triangle(number);
    const int k = triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
    const int b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
    const double ab = mesh_.distance(vertex, b), ac = mesh_.distance(vertex, c);
    const double bc = mesh_.distance(b, c);
    const Entry* known_b = findEntry(b, source);
    const Entry* known_c = findEntry(c, source);
    const double to_b = known_b ? known_b->distance : -1, to_c = known_c ? known_c->distance : -1;
    double new_b = distance + ab, new_c = distance + ac;
    if (known_c) {
      new_b = std::min(new_b, unfoldedDistance(distance, to_c, {ac, ab, bc}));
    }
    if (known_b) {
      new_c = std::min(new_c, unfoldedDistance(distance, to_b, {ab, ac, bc}));
    }
    offer(b, source, new_b);
    offer(c, source, new_c);
  }
}

void NearestSources::spread(const Progress& progress) {
  const double all = static_cast<double>(mesh_.vertexCount()) *
                     static_cast<double>(std::min(most_, sources_.size()));
  std::size_t steps = 0, accepted = 0;
  while (!heap_.empty()) {
    if (++steps % kStepsPerReport == 0) {
      InterruptionPoint::pass();
      if (progress) {
        progress(std::min(1., static_cast<double>(accepted) / all));
      }
    }
    const Waiting next = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    Entry* entry = findEntry(next.vertex, next.source);
    if (!entry || entry->distance != next.distance) {
      continue;  // a shorter one was found meanwhile
    }
    Entry* const end =
        entries_.data() + static_cast<std::size_t>(next.vertex) * capacity_ + finals_[next.vertex];
    if (entry >= end) {
      if (finals_[next.vertex] == most_) {
        continue;
      }
      std::swap(*entry, *end);
      ++finals_[next.vertex];
      ++accepted;
    }
    passOn(next.vertex, next.source, next.distance);
  }
  heap_ = {};
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
          const Entry* known = findEntry(triangle[i], entry.source);
          to[i] = known ? known->distance : std::numeric_limits<double>::infinity();
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
      found.push_back({entry.source, distance});
    }
  }
}

}  // namespace limitsurf
