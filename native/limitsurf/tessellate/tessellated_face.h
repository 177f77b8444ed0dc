// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

constexpr int kMostTessellationLevels = 12;
/// The points of a tessellation have multiples of 1 / kGridSide for u and v.
constexpr int kGridSide = 1 << kMostTessellationLevels;

/// A place on a face of the control mesh: (u, v) = (i, j) / kGridSide on its Ptex face number
/// `square`, counted from the first of that face.
struct GridPoint {
  int square, i, j;
};

/// A place on a face as an address that is unique: points at which several squares meet have only
/// one.
struct FacePlace {
  enum Kind { kVertex, kEdge, kInside } kind;
  int element;       ///< the face's vertex, or its edge from that vertex to the next
  int step;          ///< on an edge: the distance from its first vertex, in parts of 2 kGridSide
  GridPoint inside;  ///< inside the face: the place on one of the squares
};

/// The division of one face of the control mesh: into squares with 2^level quads a side, and with
/// 2^edge_levels[e] segments along edge e. A quad is one square; any other face has a square at
/// each corner, with half as many quads a side. No edge is coarser than the face.
struct FaceDivision {
  int size = 4;
  int level = 0;
  Span<int> edge_levels;

  bool isQuad() const { return size == 4; }
  int squareCount() const { return isQuad() ? 1 : size; }
  /// The level of the squares, each of which has 2^squareLevel() quads a side.
  int squareLevel() const { return isQuad() ? level : level - 1; }
  bool isUniform() const;
  /// The level of the smallest quads, counted as squareLevel().
  int finestSquareLevel() const;
  FacePlace place(const GridPoint& point) const;
};

/// Numbers for the points of a face that lie on none of its edges.
class InsideNumbers {
 public:
  static constexpr int kNone = -1;

  explicit InsideNumbers(const FaceDivision& division);

  /// The number of a place; kNone at first.
  int& operator[](const GridPoint& inside);
  bool contains(const GridPoint& inside) const;

 private:
  std::uint64_t key(const GridPoint& inside) const;

  const int level_;
  const bool is_dense_;
  std::vector<int> dense_;
  std::unordered_map<std::uint64_t, int> sparse_;
};

/// The polygons, quads and triangles, of a face some of whose edges are finer than the face itself.
///
/// A quad at an edge is split into four until it has the level of the edge, so that the sizes of
/// quads grow gradually from the edge to the face's own level. A quad with vertices of smaller
/// neighbours on its sides becomes triangles around its centre. At a corner where edges of
/// different levels meet, a quad cannot be split without adding a point to the coarser edge: it
/// becomes such triangles too, and they are thin if the levels differ by more than two.
class GradedFace {
 public:
  explicit GradedFace(const FaceDivision& division);

  std::size_t polygonCount() const { return polygon_count_; }
  std::size_t cornerCount() const { return corner_count_; }
  /// The number of points that lie on no edge.
  std::size_t insidePointCount() const { return inside_point_count_; }

  /// Calls body(corners) with the corners of each polygon, a Span of three or four GridPoints.
  template <typename Body>
  void forEachPolygon(const Body& body) const {
    std::vector<GridPoint> around;
    for (const Quad& quad : quads_) {
      outline(quad, around);
      if (around.size() == 4) {
        body(Span<GridPoint>(around));
        continue;
      }
      const int half = quad.side / 2;
      const GridPoint centre{quad.square, quad.i + half, quad.j + half};
      for (std::size_t k = 0; k < around.size(); ++k) {
        const GridPoint triangle[3] = {around[k], around[(k + 1) % around.size()], centre};
        body(Span<GridPoint>(triangle, 3));
      }
    }
  }

 private:
  struct Quad {
    int square, side, i, j;
  };

  void split(const Quad& quad);
  bool isSplit(const Quad& quad) const;
  bool exists(const GridPoint& point) const;
  void outline(const Quad& quad, std::vector<GridPoint>& around) const;
  void addHanging(const GridPoint& from, const GridPoint& to, std::vector<GridPoint>& around) const;
  /// The length of the segments along an edge, where the side of a square is kGridSide.
  int segment(int edge) const;

  const FaceDivision division_;
  const int smallest_side_;
  std::vector<Quad> quads_;
  InsideNumbers quad_corners_;
  std::size_t polygon_count_ = 0, corner_count_ = 0, inside_point_count_ = 0;
};

/// Calls body(corners) with the corners of each quad of a face that is divided uniformly.
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
