// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/tessellated_face.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// The numbers of a face are kept in an array if its grid has at most this many points, else in a
/// hash table.
constexpr std::uint64_t kMostDense = 1 << 18;

std::uint64_t gridSize(int squares, int level) {
  const std::uint64_t side = (std::uint64_t{1} << level) + 1;
  return static_cast<std::uint64_t>(squares) * side * side;
}

}  // namespace

bool FaceDivision::isUniform() const {
  return std::all_of(edge_levels.begin(), edge_levels.end(),
                     [&](int edge_level) { return edge_level == level; });
}

int FaceDivision::finestSquareLevel() const {
  const int finest = *std::max_element(edge_levels.begin(), edge_levels.end());
  return isQuad() ? finest : finest - 1;
}

FacePlace FaceDivision::place(const GridPoint& point) const {
  const auto [square, i, j] = point;
  constexpr int n = kGridSide;
  const auto onEdge = [&](int edge, int step) {
    if (step == 0 || step == 2 * n) {
      return FacePlace{FacePlace::kVertex, step == 0 ? edge : (edge + 1) % size, 0, {}};
    }
    return FacePlace{FacePlace::kEdge, edge, step, {}};
  };
  const auto inside = [](int owner, int a, int b) {
    return FacePlace{FacePlace::kInside, 0, 0, {owner, a, b}};
  };
  if (isQuad()) {
    return j == 0   ? onEdge(0, 2 * i)
           : i == n ? onEdge(1, 2 * j)
           : j == n ? onEdge(2, 2 * (n - i))
           : i == 0 ? onEdge(3, 2 * (n - j))
                    : inside(0, i, j);
  }
  const int before = (square + size - 1) % size;
  return j == 0             ? onEdge(square, i)
         : i == 0           ? onEdge(before, 2 * n - j)
         : i == n && j == n ? inside(0, n, n)  // the centre
         : j == n ? inside(before, n, i)  // on the line from the middle of an edge to the centre
                  : inside(square, i, j);
}

InsideNumbers::InsideNumbers(const FaceDivision& division)
    : level_(division.finestSquareLevel()),
      is_dense_(division.isUniform() || gridSize(division.squareCount(), level_) <= kMostDense) {
  if (is_dense_) {
    dense_.assign(gridSize(division.squareCount(), level_), kNone);
  }
}

std::uint64_t InsideNumbers::key(const GridPoint& inside) const {
  const int shift = kMostTessellationLevels - level_;
  const std::uint64_t side = (std::uint64_t{1} << level_) + 1;
  return (static_cast<std::uint64_t>(inside.square) * side + (inside.i >> shift)) * side +
         (inside.j >> shift);
}

int& InsideNumbers::operator[](const GridPoint& inside) {
  return is_dense_ ? dense_[key(inside)] : sparse_.emplace(key(inside), kNone).first->second;
}

bool InsideNumbers::contains(const GridPoint& inside) const {
  return is_dense_ ? dense_[key(inside)] != kNone : sparse_.count(key(inside)) != 0;
}

GradedFace::GradedFace(const FaceDivision& division)
    : division_(division),
      smallest_side_(kGridSide >> division.finestSquareLevel()),
      quad_corners_(division) {
  const int side = kGridSide >> division_.squareLevel();
  for (int square = 0; square < division_.squareCount(); ++square) {
    for (int j = 0; j < kGridSide; j += side) {
      for (int i = 0; i < kGridSide; i += side) {
        split({square, side, i, j});
      }
    }
  }
  for (const auto& [square, size, i, j] : quads_) {
    for (const GridPoint& corner :
         {GridPoint{square, i, j}, GridPoint{square, i + size, j},
          GridPoint{square, i + size, j + size}, GridPoint{square, i, j + size}}) {
      const FacePlace place = division_.place(corner);
      if (place.kind == FacePlace::kInside) {
        int& number = quad_corners_[place.inside];
        inside_point_count_ += number == InsideNumbers::kNone;
        number = 0;
      }
    }
  }
  std::vector<GridPoint> around;
  for (const Quad& quad : quads_) {
    outline(quad, around);
    const bool is_quad = around.size() == 4;
    polygon_count_ += is_quad ? 1 : around.size();
    corner_count_ += is_quad ? 4 : 3 * around.size();
    inside_point_count_ += !is_quad;
  }
}

int GradedFace::segment(int edge) const {
  return (division_.isQuad() ? kGridSide : 2 * kGridSide) >> division_.edge_levels[edge];
}

void GradedFace::split(const Quad& quad) {
  if (!isSplit(quad)) {
    quads_.push_back(quad);
    return;
  }
  const int half = quad.side / 2;
  for (const int j : {quad.j, quad.j + half}) {
    for (const int i : {quad.i, quad.i + half}) {
      split({quad.square, half, i, j});
    }
  }
}

bool GradedFace::isSplit(const Quad& quad) const {
  const int before = (quad.square + division_.size - 1) % division_.size;
  bool finer = false;
  const auto allows = [&](bool touches, int edge) {
    if (!touches) {
      return true;
    }
    finer = finer || segment(edge) < quad.side;
    return segment(edge) < quad.side;
  };
  const bool right = quad.i + quad.side == kGridSide, top = quad.j + quad.side == kGridSide;
  const bool allowed =
      division_.isQuad()
          ? allows(quad.j == 0, 0) && allows(right, 1) && allows(top, 2) && allows(quad.i == 0, 3)
          : allows(quad.j == 0, quad.square) && allows(quad.i == 0, before);
  return allowed && finer;
}

bool GradedFace::exists(const GridPoint& point) const {
  const FacePlace place = division_.place(point);
  if (place.kind == FacePlace::kEdge) {
    return place.step % ((2 * kGridSide) >> division_.edge_levels[place.element]) == 0;
  }
  return place.kind == FacePlace::kVertex || quad_corners_.contains(place.inside);
}

void GradedFace::addHanging(const GridPoint& from, const GridPoint& to,
                            std::vector<GridPoint>& around) const {
  const GridPoint middle{from.square, (from.i + to.i) / 2, (from.j + to.j) / 2};
  // Sides are divided by halving only: without a middle there is no other point either.
  const int length = std::abs(from.i - to.i) + std::abs(from.j - to.j);
  if (length <= smallest_side_ || !exists(middle)) {
    return;
  }
  addHanging(from, middle, around);
  around.push_back(middle);
  addHanging(middle, to, around);
}

void GradedFace::outline(const Quad& quad, std::vector<GridPoint>& around) const {
  const auto [square, side, i, j] = quad;
  const GridPoint corners[4] = {
      {square, i, j}, {square, i + side, j}, {square, i + side, j + side}, {square, i, j + side}};
  around.clear();
  for (int k = 0; k < 4; ++k) {
    around.push_back(corners[k]);
    addHanging(corners[k], corners[(k + 1) % 4], around);
  }
}

}  // namespace limitsurf
