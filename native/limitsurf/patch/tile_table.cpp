// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/tile_table.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/parallel.h"
#include "limitsurf/patch/bilinear_tiles.h"
#include "limitsurf/patch/cage_mesh.h"
#include "limitsurf/patch/refined_mesh.h"
#include "limitsurf/patch/sectors.h"
#include "limitsurf/patch/window.h"

namespace limitsurf {
namespace {

class Builder {
 public:
  Builder(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex)
      : mesh_(mesh),
        topology_(topology),
        ptex_(ptex),
        table_{RefinedPoints(mesh.vertexCount(), mesh.options()), {}, {}, {}, {}, {}},
        cage_(mesh, topology) {}

  TileTable build() {
    table_.faces.assign(ptex_.base_face.size(), TileRef{TileRef::kNone, 0});
    addRegularFaces();
    addIrregularFaces();
    groupByRing();
    return std::move(table_);
  }

 private:
  enum FaceKind : std::uint8_t { kRefused, kRegular, kIrregular };

  /// A level of refinement with what is known of its vertices.
  struct Level {
    FaceMesh& mesh;
    RefinedMesh* refined;  ///< the same mesh; none for the cage
    Sectors sectors;
    struct RingAge {
      int ring = -1, steps = 0;
    };
    std::vector<RingAge> rings;  ///< per sector

    Level(FaceMesh& face_mesh, RefinedMesh* refined_mesh, bool has_sharpness)
        : mesh(face_mesh), refined(refined_mesh), sectors(face_mesh, has_sharpness) {}
  };

  /// A face whose children are tiles, or split again.
  struct Split {
    int face;
    int index;  ///< of the four children; -1: the children are an n-gon's Ptex faces
    int depth;  ///< of the children
  };

  /// What decides whether a quad is one tile.
  struct Corners {
    std::array<bool, 4> diagonal = {false, false, false, false};
    int irregular = 0, irregular_corner = -1;
    int creases = 0, crease_side = -1;
    bool tile = true;
  };

  /// The bulk of a mesh, on all cores: quads among quads without extraordinary or sharp vertices.
  void addRegularFaces() {
    kinds_.assign(mesh_.faceCount(), kRefused);
    parallelFor(mesh_.faceCount(), 4096, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const int face = static_cast<int>(f);
        if (topology_.refused().empty() || !topology_.refused().count(face)) {
          kinds_[f] = cage_.regularFace(face) ? kRegular : kIrregular;
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
        table_.bsplines[i] = bspline(cage_, face, cage_.diagonals(face));
        table_.faces[ptex_.first[face]] = {TileRef::kBSpline, static_cast<std::uint32_t>(i)};
      }
    });
  }

  void addIrregularFaces() {
    if (std::find(kinds_.begin(), kinds_.end(), kIrregular) == kinds_.end()) {
      return;
    }
    levels_.push_back(std::make_unique<Level>(cage_, nullptr, topology_.hasSharpness()));
    std::vector<Split> splits;
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      passSometimes();
      if (kinds_[face] == kIrregular && mesh_.faceSize(face) == 4) {
        table_.faces[ptex_.first[face]] = tileOrSplit(0, face, 0, splits);
      } else if (kinds_[face] == kIrregular) {
        splits.push_back({face, -1, 0});
      }
    }
    while (!splits.empty()) {
      splits = refine(splits);
    }
  }

  void passSometimes() {
    constexpr int kFacesBetween = 4096;
    if (++faces_passed_ % kFacesBetween == 0) {
      InterruptionPoint::pass();
    }
  }

  /// Makes the children of the faces, and says which of them are to be split in their turn.
  std::vector<Split> refine(const std::vector<Split>& splits) {
    const int level = static_cast<int>(levels_.size());
    if (level > TileTable::kMostDepth) {
      throw std::logic_error("a face does not settle under subdivision");
    }
    std::vector<int> faces;
    for (const Split& split : splits) {
      faces.push_back(split.face);
    }
    meshes_.push_back(std::make_unique<RefinedMesh>(levels_.back()->mesh, faces, mesh_.options(),
                                                    topology_.hasSharpness(), table_.points));
    RefinedMesh& mesh = *meshes_.back();
    levels_.push_back(std::make_unique<Level>(mesh, &mesh, topology_.hasSharpness()));
    std::vector<Split> next;
    for (const Split& split : splits) {
      passSometimes();
      const int corners = mesh.parent().faceSize(split.face);
      for (int corner = 0; corner < corners; ++corner) {
        const TileRef child =
            tileOrSplit(level, mesh.child({split.face, corner}), split.depth, next);
        if (split.index < 0) {
          table_.faces[ptex_.first[split.face] + corner] = child;
        } else {
          table_.splits[split.index][corner] = child;
        }
      }
    }
    return next;
  }

  TileRef tileOrSplit(int level, int face, int depth, std::vector<Split>& splits) {
    const Corners corners = look(level, face);
    FaceMesh& mesh = levels_[level]->mesh;
    const bool fine = depth >= TileTable::kFineDepth;
    table_.fine = table_.fine || fine;
    if (!corners.tile) {
      table_.splits.emplace_back();
      splits.push_back({face, static_cast<int>(table_.splits.size()) - 1, depth + 1});
      return {TileRef::kSplit, static_cast<std::uint32_t>(table_.splits.size() - 1)};
    }
    if (corners.irregular > 0) {
      table_.ring_tiles.push_back(ringTile(level, {face, corners.irregular_corner}, corners));
      table_.ring_tiles.back().depth = depth;
      return {TileRef::kRing, static_cast<std::uint32_t>(table_.ring_tiles.size() - 1)};
    }
    table_.bsplines.push_back(bspline(mesh, face, corners.diagonal));
    table_.bsplines.back().fine = fine;
    if (corners.creases > 0) {
      table_.bsplines.back().crease = mesh.sharpness({face, corners.crease_side});
      table_.bsplines.back().crease_side = static_cast<std::int8_t>(corners.crease_side);
    }
    return {TileRef::kBSpline, static_cast<std::uint32_t>(table_.bsplines.size() - 1)};
  }

  Corners look(int level, int face) {
    Level& at = *levels_[level];
    Corners result;
    for (int c = 0; c < 4; ++c) {
      const int vertex = at.mesh.vertex({face, c});
      if (level == 0) {
        if (!cage_.onlyQuadsAround(vertex)) {
          result.tile = false;
          return result;
        }
        if (cage_.regularVertex(vertex)) {
          result.diagonal[c] = cage_.fan(vertex).closed;
          continue;
        }
      }
      switch (at.sectors.state(vertex)) {
        case Sectors::State::settled: {
          const Sector& sector = at.sectors.sector(at.sectors.sectorOf({face, c}));
          result.diagonal[c] = sector.regular() && sector.ring.kind == RingKind::interior;
          if (!sector.regular()) {
            ++result.irregular;
            result.irregular_corner = c;
          }
          break;
        }
        case Sectors::State::crease:
          result.diagonal[c] = true;
          break;
        default:
          result.tile = false;
          return result;
      }
    }
    if (topology_.hasSharpness()) {
      for (int side = 0; side < 4; ++side) {
        if (isSemiSharp(at.mesh.sharpness({face, side}))) {
          ++result.creases;
          result.crease_side = side;
        }
      }
    }
    result.tile = result.irregular + result.creases <= 1;
    return result;
  }

  template <typename Mesh>
  static BSplineTile bspline(Mesh& mesh, int face, const std::array<bool, 4>& diagonal) {
    const Window<Mesh> window(mesh, face, 0, diagonal);
    BSplineTile tile;
    tile.x_low = window.at(-1, 0) < 0;
    tile.x_high = window.at(2, 0) < 0;
    tile.y_low = window.at(0, -1) < 0;
    tile.y_high = window.at(0, 2) < 0;
    const int any = mesh.point(window.at(0, 0));
    for (int y = -1; y <= 2; ++y) {
      for (int x = -1; x <= 2; ++x) {
        const int vertex = window.at(x, y);
        tile.points[(y + 1) * 4 + (x + 1)] = vertex < 0 ? any : mesh.point(vertex);
      }
    }
    return tile;
  }

  RingTile ringTile(int level, FaceCorner at, const Corners& corners) {
    Level& here = *levels_[level];
    RingTile tile;
    tile.corner = at.corner;
    const Level::RingAge age = ringOf(level, here.sectors.sectorOf(at));
    tile.ring = age.ring;
    tile.ring_steps = age.steps;
    tile.face = here.sectors.positionOf(at);
    tile.sides = table_.rings[tile.ring].basis->sides(tile.face);
    const Window<FaceMesh> window(here.mesh, at.face, at.corner, corners.diagonal);
    const std::vector<int>& slots = table_.rings[tile.ring].basis->outerModes(tile.face).slots();
    tile.u_high = window.at(2, 0) < 0 && window.at(2, 1) < 0;
    tile.v_high = window.at(0, 2) < 0 && window.at(1, 2) < 0;
    tile.outer.fill(0);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      tile.outer[i] =
          outerPoint(here.mesh, window, tile_grid::xOf(slots[i]), tile_grid::yOf(slots[i]));
    }
    return tile;
  }

  /// A point of the window, continued linearly past the surface's boundary (paper, figure 2), which
  /// the vertices there, being regular, allow.
  int outerPoint(FaceMesh& mesh, const Window<FaceMesh>& window, int x, int y) {
    if (const int vertex = window.at(x, y); vertex >= 0) {
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

  /// A sector's ring, and how many steps before `level` it was built: at the coarsest level at
  /// which the vertex is settled and has only quads around it.
  Level::RingAge ringOf(int level, int sector) {
    Level& at = *levels_[level];
    at.rings.resize(at.sectors.sectorCount());
    if (at.rings[sector].ring >= 0) {
      return at.rings[sector];
    }
    Level::RingAge age;
    const int vertex = at.mesh.vertex(at.sectors.sector(sector).first);
    const int above = at.refined ? at.refined->parentVertex(vertex) : -1;
    if (above >= 0 && at.refined->parent().onlyQuadsAround(above) &&
        levels_[level - 1]->sectors.state(above) == Sectors::State::settled) {
      const int which = sector - at.sectors.firstSector(vertex);
      age = ringOf(level - 1, levels_[level - 1]->sectors.firstSector(above) + which);
      ++age.steps;
    } else {
      age.ring = static_cast<int>(table_.rings.size());
      table_.rings.push_back(makeRing(at.mesh, at.sectors.sector(sector)));
    }
    at.rings[sector] = age;
    return age;
  }

  RingPoints makeRing(FaceMesh& mesh, const Sector& sector) {
    const Ring& ring = sector.ring;
    RingPoints result;
    std::shared_ptr<const Eigenbasis>& basis = bases_[ring];
    if (!basis) {
      basis = Eigenbasis::get(ring);
    }
    result.basis = basis;
    result.points.resize(ring.size());
    FaceCorner at = sector.first;
    result.points[0] = mesh.point(mesh.vertex(at));
    for (int j = 0; j < ring.faces; ++j) {
      result.points[ring.edge(j)] = mesh.point(mesh.vertexAfter(at, 1));
      result.points[ring.face(j)] = mesh.point(mesh.vertexAfter(at, 2));
      if (j + 1 < ring.faces) {
        at = mesh.turned(at);
      } else if (ring.edges() > ring.faces) {
        result.points[ring.edge(j + 1)] = mesh.point(mesh.vertexAfter(at, 3));
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
  CageMesh cage_;
  std::vector<std::unique_ptr<RefinedMesh>> meshes_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<FaceKind> kinds_;
  unsigned faces_passed_ = 0;
  std::map<Ring, std::shared_ptr<const Eigenbasis>> bases_;
  std::map<std::pair<int, int>, int> reflections_;
};

}  // namespace

TileTable buildTileTable(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex) {
  return mesh.options().scheme == Scheme::bilinear ? buildBilinearTiles(mesh, topology, ptex)
                                                   : Builder(mesh, topology, ptex).build();
}

}  // namespace limitsurf
