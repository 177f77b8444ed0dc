// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

constexpr int kMostTessellationLevels = 12;
/// Points of a tessellation lie at multiples of 1 / kGridSide in u and v.
constexpr int kGridSide = 1 << kMostTessellationLevels;

/// A place on a face of the control mesh: (i, j) / kGridSide are u and v on its Ptex face number
/// `square`, counted from the face's first.
struct GridPoint {
  int square, i, j;
};

/// A point where several squares of a face meet has one place only.
struct FacePlace {
  enum Kind { kVertex, kEdge, kInside } kind;
  int element;       ///< the face's vertex, or its edge from that vertex to the next
  int step;          ///< on an edge: from its first vertex, in parts of 2 kGridSide
  GridPoint inside;  ///< on none: as one of the squares has it
};

/// How one face of the control mesh is to be divided: into squares of 2^level cells a side, with
/// 2^edge_levels[e] segments along its edge e. A quad is one square; any other face has one at
/// every corner, with half as many cells a side. No edge is coarser than the face.
struct FaceDivision {
  int size = 4;
  int level = 0;
  Span<int> edge_levels;

  bool isQuad() const { return size == 4; }
  int squareCount() const { return isQuad() ? 1 : size; }
  /// Of the squares, each of which has 2^squareLevel() cells a side.
  int squareLevel() const { return isQuad() ? level : level - 1; }
  bool isUniform() const;
  /// Of the smallest cells, as squareLevel().
  int finestSquareLevel() const;
  FacePlace place(const GridPoint& point) const;
};

/// A number for each point of a face that lies on none of its edges.
class InsideNumbers {
 public:
  static constexpr int kNone = -1;

  explicit InsideNumbers(const FaceDivision& division);

  /// kNone for a place that is asked for the first time.
  int& operator[](const GridPoint& inside);
  bool contains(const GridPoint& inside) const;

 private:
  std::uint64_t cell(const GridPoint& inside) const;

  const int level_;
  const bool is_dense_;
  std::vector<int> dense_;
  std::unordered_map<std::uint64_t, int> sparse_;
};

/// The polygons of a face whose edges are finer than itself, all quads and triangles.
///
/// A cell at an edge is split into four until it has the edge's level, and so ever larger cells
/// lead to those of the face's own level. Cells that see vertices of smaller neighbours on their
/// sides become triangles around their centre. At a corner where edges of different levels meet, a
/// cell cannot be split without leaving a point on the coarser one: it becomes such triangles too,
/// and they are thin if the levels differ by more than two.
class GradedFace {
 public:
  explicit GradedFace(const FaceDivision& division);

  std::size_t polygonCount() const { return polygon_count_; }
  std::size_t cornerCount() const { return corner_count_; }
  /// Points that lie on no edge.
  std::size_t insidePointCount() const { return inside_point_count_; }

  /// Calls body(corners) with the corners of each polygon, a Span of three or four GridPoints.
  template <typename Body>
  void forEachPolygon(const Body& body) const {
    std::vector<GridPoint> around;
    for (const Cell& cell : cells_) {
      outline(cell, around);
      if (around.size() == 4) {
        body(Span<GridPoint>(around));
        continue;
      }
      const int half = cell.side / 2;
      const GridPoint centre{cell.square, cell.i + half, cell.j + half};
      for (std::size_t k = 0; k < around.size(); ++k) {
        const GridPoint triangle[3] = {around[k], around[(k + 1) % around.size()], centre};
        body(Span<GridPoint>(triangle, 3));
      }
    }
  }

 private:
  struct Cell {
    int square, side, i, j;
  };

  void split(const Cell& cell);
  bool isSplit(const Cell& cell) const;
  bool exists(const GridPoint& point) const;
  void outline(const Cell& cell, std::vector<GridPoint>& around) const;
  void addHanging(const GridPoint& from, const GridPoint& to, std::vector<GridPoint>& around) const;
  /// Of the segments along an edge, as long as a square's side is kGridSide.
  int segment(int edge) const;

  const FaceDivision division_;
  const int smallest_side_;
  std::vector<Cell> cells_;
  InsideNumbers cell_corners_;
  std::size_t polygon_count_ = 0, corner_count_ = 0, inside_point_count_ = 0;
};

/// Calls body(corners) with the corners of each quad of a face that is divided alike all over.
template <typename Body>
void forEachQuad(const FaceDivision& division, const Body& body) {
  const int side = kGridSide >> division.squareLevel();
  for (int square = 0; square < division.squareCount(); ++square) {
    for (int j = 0; j < kGridSide; j += side) {
      for (int i = 0; i < kGridSide; i += side) {
        const GridPoint quad[4] = {{square, i, j},
                                   {square, i + side, j},
                                   {square, i + side, j + side},
                                   {square, i, j + side}};
        body(Span<GridPoint>(quad, 4));
      }
    }
  }
}

}  // namespace limitsurf
