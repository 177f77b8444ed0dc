// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "limitsurf/geodesic/geodesic_mesh.h"
#include "limitsurf/progress.h"

namespace limitsurf {

/// A place on the triangles.
struct MeshPlace {
  Vector3 position;
  int triangle;
};

/// For each vertex of a mesh the sources that are nearest to it along the mesh, with their
/// distances.
///
/// Distances spread from vertex to vertex, the shortest first, as in Dijkstra's algorithm (Kimmel,
/// Sethian: "Computing geodesic paths on manifolds", 1998). Each step lays the triangle ahead and
/// the source into one plane (unfolding.h), so that the wave fronts are circles instead of lines
/// and distances on flat surfaces are exact. A vertex passes on its nearest sources only.
class NearestSources {
 public:
  struct Entry {
    int source;
    int times = 0;  ///< how often it has been passed on
    double distance;
  };

  /// Each vertex keeps so many of its nearest sources, of those that are not farther away than
  /// `reach`.
  NearestSources(const GeodesicMesh& mesh, const std::vector<MeshPlace>& sources,
                 const std::vector<int>& most, const Progress& progress,
                 double reach = std::numeric_limits<double>::infinity());

  /// In no particular order.
  Span<Entry> at(int vertex) const {
    return Span<Entry>(entries_.data() + first_[vertex], counts_[vertex]);
  }

  /// How often vertices have passed on a distance: what the cost is proportional to. Mostly little
  /// more than once for each entry; where triangles are so long and thin that even better shaped
  /// ones (delaunay_flips.h) do not help, up to about fifty times.
  std::size_t timesPassedOn() const { return times_passed_on_; }

  /// The distances of all sources that the vertices of the place's triangle know, in no particular
  /// order.
  void find(const MeshPlace& place, std::vector<Entry>& found) const;

 private:
  struct Waiting {
    double distance;
    int vertex, source;
    bool operator>(const Waiting& other) const;
  };

  Entry* findEntry(int vertex, int source);
  const Entry* findEntry(int vertex, int source) const;
  double distanceTo(int vertex, int source) const;
  /// How many sources a vertex keeps, and has room for.
  std::size_t most(int vertex) const { return room(vertex) / 2; }
  std::size_t room(int vertex) const { return first_[vertex + 1] - first_[vertex]; }
  void offer(int vertex, int source, double distance, Entry* entry);
  void passOn(int vertex, int source, double distance);
  void spread(const Progress& progress);

  const GeodesicMesh& mesh_;
  const std::vector<MeshPlace>& sources_;
  double reach_;
  std::size_t times_passed_on_ = 0;
  // The first entries of a vertex are final, up to finals_; those that follow may still shrink.
  std::vector<std::size_t> first_;  // of a vertex's entries
  std::vector<Entry> entries_;
  std::vector<unsigned short> counts_, finals_;
  std::vector<Waiting> heap_;
  std::vector<Entry*> known_;  // of a vertex's neighbors, while it passes on
  std::vector<double> offered_;
};

}  // namespace limitsurf
