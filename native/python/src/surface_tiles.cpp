// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/surface_tiles.h"

#include <optional>
#include <utility>

#include "batches.h"
#include "limitsurf/surface/tiles/tile_quadtree.h"
#include "numbers.h"
#include "progress.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

constexpr char kTilesDoc[] =
    R"(tiles(face, uv, max_depth=None, *, threads=0)

The bicubic tiles in which locations lie: tables with which another program (a shader, a node tree)
evaluates the limit surface at these locations exactly, in any pose of the mesh. They correspond to
OpenSubdiv's PatchTable with local point stencils, but nothing is approximated at extraordinary vertices.

Parameters
    face: (n,) integers, Ptex face ids. One integer stands for all rows.
    uv: (n, 2), each in [0, 1].
    max_depth: 1 to 256; None means 24. The smallest tiles beside an extraordinary vertex are
        2^-max_depth of a face wide. A location that is closer to the vertex, or exactly at it, is moved
        to the nearest tile on the way from the vertex to the location. Faces are also split until
        sharpness has decayed and each part has at most one irregular vertex; these parts are split
        once more. This does not depend on max_depth.
    threads: 0 uses all cores.

Returns Tiles, with
    points_offsets (r + 1,), points_indices, points_weights: refined points as sparse rows (CSR) of
        weights on the mesh's V vertices. Row i is point V + i; points below V are the vertices.
    tile_points (t, 16): point ids of each tile's B-spline control points, v-major: column 4 y + x.
    tile_anchor (t,), tile_base (t,): point ids.
    tile (n,): the tile of each location. tile_uv (n, 2): the place in the tile, in [0, 1].
    scale (n, 2): factors that turn derivatives by tile_uv into du and dv.
    moved (n,): whether the location was moved.

With p the positions of the points and b(t) = ((1 - t)^3, 3 t^3 - 6 t^2 + 4,
-3 t^3 + 3 t^2 + 3 t + 1, t^3) / 6, a location in tile k at (s, t) has the position
    p[tile_anchor[k]] + sum of b_x(s) b_y(t) (p[tile_points[k, 4 y + x]] - p[tile_base[k]]).
The weights of the control points of small tiles add up to 0, so these points keep their digits in
single precision.

Everything depends on the topology and on the locations alone, not on the pose. Error: 1e-14 of the
diagonal of the mesh's bounding box in position, 1e-12 of the tile's size in derivatives by tile_uv.
Cost: O(1) a location, O(valence log valence) a tile beside an extraordinary vertex (at a dart
O(valence^2)).

Raises LocationError for a face or (u, v) that does not exist, MeshError for a face that has no limit
surface, ValueError for a max_depth out of range, and for more than 2^28 weights (3 GiB).

Source: Stam 1998 and Lacewell & Burley 2007, the control points of their regular sub-patches.)";

py::object tilesResult(SurfaceTiles tiles) {
  const auto tile_count = static_cast<py::ssize_t>(tiles.tile_points.size());
  const auto rows = static_cast<py::ssize_t>(tiles.moved.size());
  static_assert(sizeof(bool) == sizeof(char));
  return result("Tiles")(
      arrayOf(std::move(tiles.points_offsets)), arrayOf(std::move(tiles.points_indices)),
      arrayOf(std::move(tiles.points_weights)),
      arrayIn<int>(std::move(tiles.tile_points), {tile_count, py::ssize_t{16}}),
      arrayOf(std::move(tiles.tile_anchor)), arrayOf(std::move(tiles.tile_base)),
      arrayOf(std::move(tiles.tile)), rowArray(std::move(tiles.tile_uv)),
      rowArray(std::move(tiles.scale)), arrayIn<bool>(std::move(tiles.moved), {rows}));
}

py::object surfaceTiles(const SharedSurface& shared, const py::object& face, const py::object& uv,
                        const std::optional<int>& max_depth, int threads) {
  checkThreads(threads);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  SurfaceTiles tiles;
  {
    const LongCall call(shared.lock);
    tiles = shared.surface().tiles(at, max_depth.value_or(SurfaceTiles::kDefaultDepth), threads);
  }
  return tilesResult(std::move(tiles));
}

constexpr char kQuadtreeDoc[] =
    R"(tile_quadtree(max_depth=None, *, threads=0, progress=None)

All bicubic tiles of this surface, and for each Ptex face a quadtree that leads from (u, v) to the
tile. With them another program can evaluate the limit surface at any location.

Parameters
    max_depth: 1 to 48, otherwise as in tiles(). What lies closer to an irregular vertex gets the tile beside it.
    threads: 0 uses all cores.
    progress: a function that is called from time to time with the part of the work that is done, 0
        to 1. An exception that it raises ends the call.

Returns TileQuadtree, with
    child (nodes,): of an inner node, the number of the first of its four children; of a leaf, -1 minus
        the number of its tile; -2^23 for a face that has no limit surface. Node f is the root of Ptex
        face f.
    tiles: Tiles, with a location in the middle of each tile, or several.
    origin (t, 2): the (u, v) of the face at which each tile begins.
    levels: the depth of the deepest leaf.

To find the tile of (u, v), begin at node f and repeat this step while c = child[node] is not negative:
a = u >= 1/2, b = v >= 1/2, the next node is c + 2 b + a, and (u, v) becomes (2 u - a, 2 v - b). The
place in the tile is ((u, v) on the face - origin[tile]) * scale, with the `scale` of the tile's
location, clamped to 0 to 1.

Depends on the topology alone. Cost: O(max_depth) nodes at each irregular vertex, and that of
tiles() for as many locations: the tiles around a vertex of N faces have 900 N^2 to 2100 N^2 weights
at the default depth. Raises ValueError for a max_depth out of range, and for more than 2^28 weights (3 GiB).)";

py::object tileQuadtree(const SharedSurface& shared, const std::optional<int>& max_depth,
                        int threads, const py::object& progress) {
  checkThreads(threads);
  const ProgressReport report(progress);
  double part = 0;
  TileQuadtree tree;
  {
    const GilRelease release;
    const CallLock::Hold hold(shared.lock);
    // The steps of the work are long: what has been done is told again meanwhile.
    const InterruptionPoint point = interruptible([&] { report(part); });
    tree =
        limitsurf::tileQuadtree(shared.surface(), max_depth.value_or(SurfaceTiles::kDefaultDepth),
                                threads, [&](double done) { report(part = done); });
  }
  return result("TileQuadtree")(arrayOf(std::move(tree.child)), tilesResult(std::move(tree.tiles)),
                                rowArray(std::move(tree.origin)), tree.levels);
}

}  // namespace

void bindSurfaceTiles(SurfaceClass& type) {
  using namespace py::literals;
  type.def("tiles", &surfaceTiles, "face"_a, "uv"_a, "max_depth"_a = py::none(), py::kw_only(),
           "threads"_a = 0, kTilesDoc)
      .def("tile_quadtree", &tileQuadtree, "max_depth"_a = py::none(), py::kw_only(),
           "threads"_a = 0, "progress"_a = py::none(), kQuadtreeDoc);
}

}  // namespace limitsurf::python
