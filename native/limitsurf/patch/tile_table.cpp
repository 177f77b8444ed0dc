// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/tile_table.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/mesh/topology.h"
#include "limitsurf/parallel.h"
#include "limitsurf/part_array.h"
#include "limitsurf/patch/bilinear_tiles.h"
#include "limitsurf/patch/refinement_level.h"
#include "limitsurf/patch/ring_tile_maker.h"
#include "limitsurf/patch/window.h"

namespace limitsurf {
namespace {

/// So many faces take 100 microseconds and more: to look at them, and to make their tiles.
constexpr std::size_t kLookedAtPerTask = 32768, kFacesPerTask = 4096;

/// The tile of a quad that is regular at all corners.
BSplineTile bsplineTile(FaceMesh& mesh, int face, const std::array<bool, 4>& diagonal) {
  const Window window(mesh, face, 0, diagonal);
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

class Builder {
 public:
  Builder(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex)
      : mesh_(mesh),
        topology_(topology),
        ptex_(ptex),
        table_{RefinedPoints(mesh.vertexCount(), mesh.options()), {}, {}, {}, {}, {}},
        cage_(mesh, topology),
        ring_tiles_(table_, levels_) {}

  TileTable build() {
    table_.faces.assign(ptex_.base_face.size(), TileRef{TileRef::kNone, 0});
    findKinds();
    regular_count_ = static_cast<std::size_t>(std::count(kinds_.begin(), kinds_.end(), kRegular));
    addIrregularFaces();
    addRegularFaces();
    return std::move(table_);
  }

 private:
  enum FaceKind : std::uint8_t { kRefused, kRegular, kIrregular };

  /// A face whose children are tiles, or are split again.
  struct Split {
    int face;
    int index;  ///< of the four children; -1: the children are an n-gon's Ptex faces
    int depth;  ///< of the children
  };

  void findKinds() {
    kinds_.assign(mesh_.faceCount(), kRefused);
    parallelFor(mesh_.faceCount(), kLookedAtPerTask, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const int face = static_cast<int>(f);
        if (topology_.refused().empty() || !topology_.refused().count(face)) {
          kinds_[f] = cage_.regularFace(face) ? kRegular : kIrregular;
        }
      }
    });
  }

  /// Quads among quads without extraordinary or sharp vertices, which most meshes mainly consist
  /// of, on all cores. They come first in the table, but are made last, so that the memory of the
  /// levels serves them.
  void addRegularFaces() {
    std::vector<int> regular_faces;
    regular_faces.reserve(regular_count_);
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      if (kinds_[face] == kRegular) {
        regular_faces.push_back(face);
      }
    }
    table_.bsplines.reserve(regular_count_ + irregular_bsplines_.size());
    table_.bsplines.resize(regular_count_);
    parallelFor(regular_faces.size(), kFacesPerTask, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int face = regular_faces[i];
        table_.bsplines[i] = bsplineTile(cage_, face, cage_.diagonals(face));
        table_.faces[ptex_.first[face]] = {TileRef::kBSpline, static_cast<std::uint32_t>(i)};
      }
    });
    irregular_bsplines_.moveTo(table_.bsplines);
  }

  /// The other faces, level by level.
  void addIrregularFaces() {
    if (std::find(kinds_.begin(), kinds_.end(), kIrregular) == kinds_.end()) {
      return;
    }
    levels_.push_back(std::make_unique<RefinementLevel>(cage_, topology_.hasSharpness()));
    std::vector<Split> splits;
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      stride_.step();
      if (kinds_[face] == kIrregular && mesh_.faceSize(face) == 4) {
        table_.faces[ptex_.first[face]] = tileOrSplit(0, face, 0, splits);
      } else if (kinds_[face] == kIrregular) {
        splits.push_back({face, -1, 0});
      }
    }
    while (!splits.empty()) {
      splits = refine(splits);
    }
    groupByRing(table_);
    for (; !levels_.empty(); levels_.pop_back()) {  // which takes long where there is much in them
      InterruptionPoint::pass();
    }
    for (; !meshes_.empty(); meshes_.pop_back()) {
      InterruptionPoint::pass();
    }
    table_.points.shrink();
    shrinkToSize(table_.splits);
    shrinkToSize(table_.rings);
  }

  /// Makes the children of the faces, and returns those of them that are to be split in their turn.
  std::vector<Split> refine(const std::vector<Split>& splits) {
    const int level = static_cast<int>(levels_.size());
    if (level > TileTable::kMostDepth) {
      throw std::logic_error("a face is still no tile after the deepest split");
    }
    std::vector<int> faces;
    faces.reserve(splits.size());
    for (const Split& split : splits) {
      faces.push_back(split.face);
    }
    meshes_.push_back(std::make_unique<RefinedMesh>(levels_.back()->mesh, faces, mesh_.options(),
                                                    topology_.hasSharpness(), table_.points));
    RefinedMesh& mesh = *meshes_.back();
    levels_.push_back(std::make_unique<RefinementLevel>(mesh, topology_.hasSharpness()));
    std::vector<Split> next;
    for (const Split& split : splits) {
      stride_.step();
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
    const QuadCorners corners = cornersOf(*levels_[level], face);
    FaceMesh& mesh = levels_[level]->mesh;
    const bool fine = depth >= TileTable::kFineDepth;
    table_.fine = table_.fine || fine;
    if (!corners.is_tile) {
      table_.splits.emplace_back();
      splits.push_back({face, static_cast<int>(table_.splits.size()) - 1, depth + 1});
      return {TileRef::kSplit, static_cast<std::uint32_t>(table_.splits.size() - 1)};
    }
    if (corners.irregular > 0) {
      table_.ring_tiles.push_back(
          ring_tiles_.make(level, {face, corners.irregular_corner}, corners.diagonal));
      table_.ring_tiles.back().depth = depth;
      return {TileRef::kRing, static_cast<std::uint32_t>(table_.ring_tiles.size() - 1)};
    }
    BSplineTile tile = bsplineTile(mesh, face, corners.diagonal);
    tile.fine = fine;
    if (corners.creases > 0) {
      tile.crease = mesh.sharpness({face, corners.crease_side});
      tile.crease_side = static_cast<std::int8_t>(corners.crease_side);
    }
    irregular_bsplines_.push_back(tile);
    return {TileRef::kBSpline,
            static_cast<std::uint32_t>(regular_count_ + irregular_bsplines_.size() - 1)};
  }

  const ControlMesh& mesh_;
  const Topology& topology_;
  const PtexFaces& ptex_;
  TileTable table_;
  CageMesh cage_;
  std::vector<std::unique_ptr<RefinedMesh>> meshes_;
  std::vector<std::unique_ptr<RefinementLevel>> levels_;
  RingTileMaker ring_tiles_;
  std::vector<FaceKind> kinds_;
  std::size_t regular_count_ = 0;
  PartArray<BSplineTile> irregular_bsplines_;  // which follow those of regular faces
  InterruptionStride stride_;
};

}  // namespace

TileTable buildTileTable(const ControlMesh& mesh, const Topology& topology, const PtexFaces& ptex) {
  return mesh.options().scheme == Scheme::bilinear ? buildBilinearTiles(mesh, topology, ptex)
                                                   : Builder(mesh, topology, ptex).build();
}

}  // namespace limitsurf
