// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/tile_quadtree.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// A square of a Ptex face, with the node that stands for it.
struct Cell {
  int node, face;
  double u, v;  ///< of its lower corner
};

std::vector<Location> middlesOf(const std::vector<Cell>& cells, double size) {
  std::vector<Location> middles;
  middles.reserve(cells.size());
  for (const Cell& cell : cells) {
    middles.push_back({cell.face, cell.u + size / 2, cell.v + size / 2});
  }
  return middles;
}

/// Where the tile of a location begins on its face.
Eigen::RowVector2d originOf(const TilePlaces& tiles, std::size_t location, const Location& at) {
  const auto row = static_cast<Eigen::Index>(location);
  return Eigen::RowVector2d(at.u, at.v) -
         tiles.tile_uv.row(row).cwiseQuotient(tiles.scale.row(row));
}

/// Whether the tile of the cell's middle covers the cell. A middle that was moved lies beside an
/// irregular vertex: the tile that it was moved to stands for all that is nearer to the vertex.
bool covers(const TilePlaces& tiles, std::size_t location, const Location& middle, const Cell& cell,
            double size) {
  const auto row = static_cast<Eigen::Index>(location);
  const Eigen::RowVector2d begin = originOf(tiles, location, middle),
                           end = begin + tiles.scale.row(row).cwiseInverse(),
                           corner(cell.u, cell.v);
  const bool holds_all =
      (begin.array() <= corner.array()).all() && (end.array() >= corner.array() + size).all();
  return holds_all || tiles.moved[location];
}

/// One cell for each face that has a limit surface.
std::vector<Cell> wholeFaces(const LimitSurface& surface) {
  std::vector<Cell> cells;
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[static_cast<std::size_t>(face)]) == 0) {
      cells.push_back({face, face, 0, 0});
    }
  }
  return cells;
}

}  // namespace

TileQuadtree tileQuadtree(const LimitSurface& surface, int max_depth, int threads,
                          const Progress& progress) {
  if (max_depth < 1 || max_depth > TileQuadtree::kLargestDepth) {
    throw std::invalid_argument("max_depth is " + std::to_string(max_depth) + "; expected 1 to " +
                                std::to_string(TileQuadtree::kLargestDepth));
  }
  const auto tell = [&](double part) {
    if (progress) {
      progress(part);
    }
  };
  TileQuadtree out;
  out.child.assign(static_cast<std::size_t>(surface.faceCount()), TileQuadtree::kNoTile);
  std::vector<Cell> cells = wholeFaces(surface);
  std::vector<int> covered_nodes;
  std::vector<Location> covered;
  InterruptionStride stride;
  for (double size = 1; !cells.empty(); size /= 2) {
    const std::vector<Location> middles = middlesOf(cells, size);
    const TilePlaces tiles = surface.tilePlaces(middles, max_depth, threads);
    std::vector<Cell> next;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      stride.step();
      const Cell& cell = cells[i];
      if (covers(tiles, i, middles[i], cell, size)) {
        covered_nodes.push_back(cell.node);
        covered.push_back(middles[i]);
        continue;
      }
      const int first = static_cast<int>(out.child.size());
      out.child[static_cast<std::size_t>(cell.node)] = first;
      out.child.resize(out.child.size() + 4, TileQuadtree::kNoTile);
      for (int quarter = 0; quarter < 4; ++quarter) {
        const int a = quarter % 2, b = quarter / 2;
        next.push_back({first + quarter, cell.face, cell.u + a * size / 2, cell.v + b * size / 2});
      }
    }
    out.levels += next.empty() ? 0 : 1;
    tell((1 - size / 2) / 2);  // finding the places takes about half of the time
    cells = std::move(next);
  }

  out.tiles =
      surface.tiles(covered, max_depth, threads, [&](double part) { tell((1 + part) / 2); });
  tell(1);
  out.origin.setZero(static_cast<Eigen::Index>(out.tiles.tile_points.size()), 2);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    stride.step();
    const int tile = out.tiles.tile[i];
    out.child[static_cast<std::size_t>(covered_nodes[i])] = -1 - tile;
    if (!out.tiles.moved[i]) {
      out.origin.row(tile) = originOf(out.tiles, i, covered[i]);
    }
  }
  return out;
}

}  // namespace limitsurf
