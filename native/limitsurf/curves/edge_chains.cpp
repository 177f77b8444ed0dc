// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/edge_chains.h"

#include <algorithm>

#include "limitsurf/mesh/messages.h"
#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {
namespace {

constexpr MeshEdges::Use kNoUse = {-1, 0};

/// Links chosen edges to chains.
class ChainBuilder {
 public:
  ChainBuilder(const LimitSurface& surface, const MeshEdges& edges, std::vector<bool> chosen)
      : surface_(surface), edges_(edges), chosen_(std::move(chosen)) {
    for (int edge = 0; edge < edges_.count(); ++edge) {
      if (isChosen(edge) && !hasSurface(edge)) {
        chosen_[static_cast<std::size_t>(edge)] = false;
        ++chains_.left_out;
      }
    }
    at_vertex_.resize(static_cast<std::size_t>(surface.mesh().vertexCount()));
    for (int edge = 0; edge < edges_.count(); ++edge) {
      if (isChosen(edge)) {
        for (const int vertex : edges_.vertices(edge)) {
          Meeting& meeting = at_vertex_[static_cast<std::size_t>(vertex)];
          if (meeting.count < 2) {
            meeting.edges[meeting.count] = edge;
          }
          ++meeting.count;
        }
      }
    }
  }

  EdgeChains build() {
    for (int edge = 0; edge < edges_.count(); ++edge) {
      if (isChosen(edge)) {
        addChain(edge);
      }
    }
    return std::move(chains_);
  }

 private:
  /// The chosen edges at a vertex, the first two of them by number.
  struct Meeting {
    int count = 0;
    int edges[2] = {-1, -1};
  };

  bool isChosen(int edge) const { return chosen_[static_cast<std::size_t>(edge)]; }

  bool isRefused(int face) const { return surface_.refused().count(face) != 0; }

  bool hasSurface(int edge) const {
    const Span<MeshEdges::Use> uses = edges_.uses(edge);
    return std::any_of(uses.begin(), uses.end(),
                       [&](const MeshEdges::Use& use) { return !isRefused(use.face); });
  }

  /// The other chosen edge at a vertex where two meet, or -1.
  int next(int edge, int vertex) const {
    const Meeting& meeting = at_vertex_[static_cast<std::size_t>(vertex)];
    if (meeting.count != 2) {
      return -1;
    }
    return meeting.edges[0] == edge ? meeting.edges[1] : meeting.edges[0];
  }

  void addChain(int first) {
    const std::array<int, 2> ends = edges_.vertices(first);
    std::vector<EdgeChains::Edge> forward, backward;
    const bool closed = follow(first, ends[0], ends[1], forward);
    if (!closed) {
      const int before = next(first, ends[0]);
      if (before >= 0) {
        follow(before, otherEnd(before, ends[0]), ends[0], backward, true);
      }
    }
    chains_.edges.insert(chains_.edges.end(), backward.rbegin(), backward.rend());
    chains_.edges.insert(chains_.edges.end(), forward.begin(), forward.end());
    chains_.offsets.push_back(static_cast<std::int64_t>(chains_.edges.size()));
    chains_.closed.push_back(closed);
  }

  /// Adds the edge from one vertex to another and those that go on from there; `against` the
  /// chain's direction those that lead to it. Returns whether they end where they began.
  bool follow(int edge, int from, int to, std::vector<EdgeChains::Edge>& out,
              bool against = false) {
    const int start = edge;
    while (true) {
      chosen_[static_cast<std::size_t>(edge)] = false;
      out.push_back(directed(edge, from, to));
      const int vertex = against ? from : to;
      edge = next(edge, vertex);
      if (edge < 0 || edge == start) {
        return edge == start;
      }
      (against ? to : from) = vertex;
      (against ? from : to) = otherEnd(edge, vertex);
    }
  }

  int otherEnd(int edge, int vertex) const {
    const std::array<int, 2>& ends = edges_.vertices(edge);
    return ends[0] == vertex ? ends[1] : ends[0];
  }

  EdgeChains::Edge directed(int edge, int from, int to) const {
    EdgeChains::Edge result{{from, to}, kNoUse, kNoUse};
    for (const MeshEdges::Use& use : edges_.uses(edge)) {
      if (isRefused(use.face)) {
        continue;
      }
      const Span<int> vertices = surface_.mesh().faceVertices(use.face);
      MeshEdges::Use& side =
          vertices[static_cast<std::size_t>(use.corner)] == from ? result.left : result.right;
      if (side.face < 0) {
        side = use;
      }
    }
    return result;
  }

  const LimitSurface& surface_;
  const MeshEdges& edges_;
  std::vector<bool> chosen_;
  std::vector<Meeting> at_vertex_;
  EdgeChains chains_;
};

/// The edges with a sharpness above 0. Of several values for an edge the last one counts.
std::vector<bool> sharpEdges(const ControlMesh& mesh, const MeshEdges& edges) {
  std::vector<bool> sharp(static_cast<std::size_t>(edges.count()), false);
  const EdgeSharpness& given = mesh.options().edge_sharpness;
  for (std::size_t i = 0; i < given.edges.size(); ++i) {
    const int edge = edges.find(given.edges[i].first, given.edges[i].second);
    if (edge >= 0) {
      sharp[static_cast<std::size_t>(edge)] = isSharp(static_cast<float>(given.values[i]));
    }
  }
  return sharp;
}

/// Whether two faces use the edge, one in each direction.
bool isManifold(const ControlMesh& mesh, const Span<MeshEdges::Use>& uses) {
  if (uses.size() != 2) {
    return false;
  }
  const auto from = [&](const MeshEdges::Use& use) {
    return mesh.faceVertices(use.face)[static_cast<std::size_t>(use.corner)];
  };
  return from(uses[0]) != from(uses[1]);
}

}  // namespace

EdgeChains edgeChains(const LimitSurface& surface, const MeshEdges& edges, EdgeChoice choice) {
  std::vector<bool> chosen = choice == EdgeChoice::creases
                                 ? sharpEdges(surface.mesh(), edges)
                                 : std::vector<bool>(static_cast<std::size_t>(edges.count()));
  for (int edge = 0; edge < edges.count(); ++edge) {
    const Span<MeshEdges::Use> uses = edges.uses(edge);
    const auto i = static_cast<std::size_t>(edge);
    if (choice == EdgeChoice::boundary) {
      chosen[i] = uses.size() == 1;
    } else if (uses.size() == 1) {
      chosen[i] = false;
    } else if (!isManifold(surface.mesh(), uses)) {
      chosen[i] = true;
    }
  }
  return ChainBuilder(surface, edges, std::move(chosen)).build();
}

EdgeChains edgeChains(const LimitSurface& surface, const MeshEdges& edges,
                      const std::vector<std::pair<std::int64_t, std::int64_t>>& chosen) {
  std::vector<bool> flags(static_cast<std::size_t>(edges.count()), false);
  for (std::size_t row = 0; row < chosen.size(); ++row) {
    const int edge = edges.find(chosen[row].first, chosen[row].second);
    if (edge < 0) {
      refuse("edges, row ", row, ": the mesh has no edge between the vertices ", chosen[row].first,
             " and ", chosen[row].second);
    }
    flags[static_cast<std::size_t>(edge)] = true;
  }
  return ChainBuilder(surface, edges, std::move(flags)).build();
}

}  // namespace limitsurf
