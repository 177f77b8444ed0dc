// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/tile_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/parallel.h"
#include "limitsurf/patch/cage_mesh.h"
#include "limitsurf/patch/child_mesh.h"

namespace limitsurf {
namespace {

/// The vertices around a quad on the grid -1 <= x, y <= 2, as far as the corners' own faces hold
/// them; -1 where there is none. Needs quads all around.
class Window {
 public:
  /// Corner `origin` of the quad is put at (0, 0), the next one at (1, 0).
  Window(const FaceMesh& mesh, FaceId face, int origin) {
    vertices_.fill(-1);
    for (int i = 0; i < 4; ++i) {
      const FaceCorner here = {face, (origin + i) % 4};
      set(i, 0, 0, mesh.vertex(here));
      const FaceCorner next = mesh.turned(here);
      if (next.exists()) {
        set(i, -1, 1, mesh.vertexAfter(next, 2));
        set(i, -1, 0, mesh.vertexAfter(next, 3));
        if (const VertexFan fan = mesh.fan(mesh.vertex(here)); fan.interior && fan.regular()) {
          set(i, -1, -1, mesh.vertexAfter(mesh.turned(next), 2));
        }
      }
      if (const FaceCorner previous = mesh.turnedBack(here); previous.exists()) {
        set(i, 0, -1, mesh.vertexAfter(previous, 1));
        set(i, 1, -1, mesh.vertexAfter(previous, 2));
      }
    }
  }

  VertexId at(int x, int y) const { return vertices_[(y + 1) * 4 + (x + 1)]; }

 private:
  /// (x, y) as seen from corner i, with its next corner at (1, 0).
  void set(int i, int x, int y, VertexId vertex) {
    for (; i > 0; --i) {
      std::tie(x, y) = std::pair(1 - y, x);
    }
    vertices_[(y + 1) * 4 + (x + 1)] = vertex;
  }

  std::array<VertexId, 16> vertices_;
};

class Builder {
 public:
  Builder(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex)
      : mesh_(mesh),
        topology_(topology),
        ptex_(ptex),
        table_{RefinedPoints(mesh.vertexCount(), mesh.options().triangles), {}, {}, {}, {}, {}},
        cage_corners_(mesh),
        levels_{CageMesh(topology, cage_corners_, mesh.options().boundary),
                ChildMesh(levels_.cage, cage_corners_, table_.points),
                ChildMesh(levels_.child, quad_corners_, table_.points)} {}

  TileTable build() {
    table_.faces.assign(ptex_.base_face.size(), TileRef{TileRef::kNone, 0});
    addRegularFaces();
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      if (kinds_[face] == kIrregular) {
        addIrregularFace(face);
      }
    }
    groupByRing();
    return std::move(table_);
  }

 private:
  enum FaceKind : std::uint8_t { kRefused, kRegular, kIrregular };

  struct Levels {
    CageMesh cage;
    ChildMesh child, grandchild;
  };

  /// Corners with extraordinary vertices.
  struct Irregular {
    int count = 0, first = 0;

    Irregular(const FaceMesh& mesh, FaceId face) {
      for (int corner = 3; corner >= 0; --corner) {
        if (!mesh.fan(mesh.vertex({face, corner})).regular()) {
          ++count;
          first = corner;
        }
      }
    }
  };

  static bool amongQuads(const FaceMesh& mesh, FaceId quad) {
    for (int corner = 0; corner < 4; ++corner) {
      if (!mesh.onlyQuadsAround(mesh.vertex({quad, corner}))) {
        return false;
      }
    }
    return true;
  }

  /// The bulk of a mesh, on all cores: quads among quads without extraordinary vertices.
  void addRegularFaces() {
    kinds_.assign(mesh_.faceCount(), kRefused);
    parallelFor(mesh_.faceCount(), 4096, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const int face = static_cast<int>(f);
        if (topology_.refused().empty() || !topology_.refused().count(face)) {
          kinds_[f] = levels_.cage.regularFace(face) ? kRegular : kIrregular;
        }
      }
    });
    std::vector<int> regular_faces;
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      if (kinds_[face] == kRegular) {
        regular_faces.push_back(face);
      }
    }
    table_.bsplines.resize(regular_faces.size());
    parallelFor(regular_faces.size(), 4096, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int face = regular_faces[i];
        table_.bsplines[i] = bspline(levels_.cage, face);
        table_.faces[ptex_.first[face]] = {TileRef::kBSpline, static_cast<std::uint32_t>(i)};
      }
    });
  }

  void addIrregularFace(int face) {
    if (mesh_.faceSize(face) == 4) {
      const Irregular irregular(levels_.cage, face);
      table_.faces[ptex_.first[face]] = amongQuads(levels_.cage, face) && irregular.count <= 1
                                            ? tile(levels_.cage, 0, face, irregular, 0)
                                            : split(levels_.child, 1, face);
      return;
    }
    for (int corner = 0; corner < mesh_.faceSize(face); ++corner) {
      const FaceId child = levels_.child.child({face, corner});
      const Irregular irregular(levels_.child, child);
      table_.faces[ptex_.first[face] + corner] = irregular.count <= 1
                                                     ? tile(levels_.child, 1, child, irregular, 0)
                                                     : split(levels_.grandchild, 2, child);
    }
  }

  /// Four children of a quad of the level above `mesh`. None has more than one extraordinary
  /// vertex.
  TileRef split(ChildMesh& mesh, int level, FaceId parent) {
    std::array<TileRef, 4> children;
    for (int corner = 0; corner < 4; ++corner) {
      const FaceId child = mesh.child({parent, corner});
      children[corner] = tile(mesh, level, child, Irregular(mesh, child), 1);
    }
    table_.splits.push_back(children);
    return {TileRef::kSplit, static_cast<std::uint32_t>(table_.splits.size() - 1)};
  }

  TileRef tile(FaceMesh& mesh, int level, FaceId face, const Irregular& irregular, int depth) {
    if (irregular.count > 0) {
      table_.ring_tiles.push_back(ringTile(mesh, level, {face, irregular.first}));
      table_.ring_tiles.back().depth = depth;
      return {TileRef::kRing, static_cast<std::uint32_t>(table_.ring_tiles.size() - 1)};
    }
    table_.bsplines.push_back(bspline(mesh, face));
    return {TileRef::kBSpline, static_cast<std::uint32_t>(table_.bsplines.size() - 1)};
  }

  static BSplineTile bspline(FaceMesh& mesh, FaceId face) {
    const Window window(mesh, face, 0);
    BSplineTile tile;
    tile.x_low = window.at(-1, 0) < 0;
    tile.x_high = window.at(2, 0) < 0;
    tile.y_low = window.at(0, -1) < 0;
    tile.y_high = window.at(0, 2) < 0;
    const int any = mesh.point(window.at(0, 0));
    for (int y = -1; y <= 2; ++y) {
      for (int x = -1; x <= 2; ++x) {
        const VertexId vertex = window.at(x, y);
        tile.points[(y + 1) * 4 + (x + 1)] = vertex < 0 ? any : mesh.point(vertex);
      }
    }
    return tile;
  }

  RingTile ringTile(FaceMesh& mesh, int level, FaceCorner at) {
    RingTile tile;
    tile.corner = at.corner;
    const auto [ring, steps] = ringOf(mesh, level, mesh.vertex(at));
    tile.ring = ring;
    tile.ring_steps = steps;
    tile.face = mesh.positionOf(at);
    tile.sides = table_.rings[ring].basis->sides(tile.face);
    const Window window(mesh, at.face, at.corner);
    const std::vector<int>& cells = table_.rings[ring].basis->outerModes(tile.face).cells();
    tile.outer.fill(0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      tile.outer[i] = outerPoint(mesh, window, tile_grid::xOf(cells[i]), tile_grid::yOf(cells[i]));
    }
    return tile;
  }

  /// A point of the window, continued linearly past the surface's boundary (paper, figure 2), which
  /// the vertices there, being regular, allow.
  int outerPoint(FaceMesh& mesh, const Window& window, int x, int y) {
    if (const VertexId vertex = window.at(x, y); vertex >= 0) {
      return mesh.point(vertex);
    }
    const bool beyond_x = x == 2 && window.at(2, 0) < 0 && window.at(2, 1) < 0;
    const int inner =
        beyond_x ? outerPoint(mesh, window, x - 1, y) : outerPoint(mesh, window, x, y - 1);
    const int next =
        beyond_x ? outerPoint(mesh, window, x - 2, y) : outerPoint(mesh, window, x, y - 2);
    const auto [known, is_new] = reflections_.try_emplace({inner, next}, 0);
    if (is_new) {
      known->second = table_.points.addReflection(inner, next);
    }
    return known->second;
  }

  /// The ring of a vertex, and how many steps before `level` it was built: at the coarsest level at
  /// which the vertex has only quads around it.
  std::pair<int, int> ringOf(FaceMesh& mesh, int level, VertexId vertex) {
    if (level > 0) {
      ChildMesh& child = static_cast<ChildMesh&>(mesh);
      const VertexId above = child.parentVertex(vertex);
      if (above >= 0 && child.parent().onlyQuadsAround(above)) {
        const auto [ring, steps] = ringOf(child.parent(), level - 1, above);
        return {ring, steps + 1};
      }
    }
    const auto [known, is_new] =
        known_rings_.try_emplace({level, vertex}, static_cast<int>(table_.rings.size()));
    if (is_new) {
      table_.rings.push_back(makeRing(mesh, vertex));
    }
    return {known->second, 0};
  }

  static RingPoints makeRing(FaceMesh& mesh, VertexId vertex) {
    const VertexFan fan = mesh.fan(vertex);
    const int faces = fan.faces;
    const Ring ring{fan.interior ? RingKind::interior
                    : fan.pinned ? RingKind::pinned
                                 : RingKind::boundary,
                    faces};
    RingPoints result;
    result.basis = Eigenbasis::get(ring);
    result.points.resize(ring.size());
    result.points[0] = mesh.point(vertex);
    for (int j = 0; j < faces; ++j) {
      const FaceCorner at = mesh.faceAt(vertex, j);
      result.points[ring.edge(j)] = mesh.point(mesh.vertexAfter(at, 1));
      result.points[ring.face(j)] = mesh.point(mesh.vertexAfter(at, 2));
      if (!ring.closed() && j == faces - 1) {
        result.points[ring.edge(faces)] = mesh.point(mesh.vertexAfter(at, 3));
      }
    }
    return result;
  }

  /// Orders ring tiles by their ring, so that what a ring computes serves its tiles in a row.
  void groupByRing() {
    std::vector<int> order(table_.ring_tiles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return table_.ring_tiles[a].ring < table_.ring_tiles[b].ring;
    });
    std::vector<RingTile> sorted;
    sorted.reserve(order.size());
    std::vector<std::uint32_t> place(order.size());
    for (const int old : order) {
      place[old] = static_cast<std::uint32_t>(sorted.size());
      sorted.push_back(table_.ring_tiles[old]);
    }
    table_.ring_tiles = std::move(sorted);
    const auto renumber = [&](TileRef& ref) {
      if (ref.kind == TileRef::kRing) {
        ref.index = place[ref.index];
      }
    };
    std::for_each(table_.faces.begin(), table_.faces.end(), renumber);
    for (auto& children : table_.splits) {
      std::for_each(children.begin(), children.end(), renumber);
    }
  }

  const ControlMesh& mesh_;
  const Topology& topology_;
  const PtexFaces& ptex_;
  TileTable table_;
  const CageCorners cage_corners_;
  const QuadCorners quad_corners_;
  Levels levels_;
  std::vector<FaceKind> kinds_;
  std::map<std::pair<int, VertexId>, int> known_rings_;
  std::map<std::pair<int, int>, int> reflections_;
};

}  // namespace

PtexFaces::PtexFaces(const ControlMesh& mesh) {
  for (int face = 0; face < mesh.faceCount(); ++face) {
    first.push_back(static_cast<int>(base_face.size()));
    const int size = mesh.faceSize(face);
    for (int c = 0; c < (size == 4 ? 1 : size); ++c) {
      base_face.push_back(face);
      corner.push_back(c);
    }
  }
  first.push_back(static_cast<int>(base_face.size()));
}

TileTable buildTileTable(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex) {
  return Builder(mesh, topology, ptex).build();
}

}  // namespace limitsurf
