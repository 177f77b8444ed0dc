// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {

/// Which sides of an extraordinary vertex's face lie on the boundary of the vertex's sector.
enum class Sides {
  inner,  ///< neither
  left,   ///< the u axis (first face of a sector)
  right,  ///< the v axis (last face of a sector)
  both,   ///< both (a sector of one face)
};

constexpr bool onLeft(Sides sides) { return sides == Sides::left || sides == Sides::both; }
constexpr bool onRight(Sides sides) { return sides == Sides::right || sides == Sides::both; }

/// The control points around one quad of an extraordinary vertex, laid out as a 5 x 5 grid.
///
/// Slot (x, y), -1 <= x, y <= 3, holds the control point at (x, y) when the extraordinary vertex is
/// at (0, 0) and the face is [0, 1]^2. Slot (-1, -1) has no point. Before a subdivision the 15
/// slots with x, y <= 2 determine the face. After it all 24 slots determine the three quarters that
/// are regular: the 4 x 4 window from (a - 1, b - 1) to (a + 2, b + 2) belongs to quarter (a, b),
/// as the picking matrices P_k of Lacewell & Burley 2007, section 2, select it.
namespace tile_grid {

constexpr int kSize = 5;
constexpr int kSlots = kSize * kSize;
constexpr int slot(int x, int y) { return (y + 1) * kSize + (x + 1); }
constexpr int xOf(int c) { return c % kSize - 1; }
constexpr int yOf(int c) { return c / kSize - 1; }

/// The slots of ring points: v, e_j, f_j, e_j+1, f_j+1, e_j+2, e_j-1, f_j-1.
constexpr std::array<int, 8> kRingSlots = {slot(0, 0),  slot(1, 0),  slot(1, 1),  slot(0, 1),
                                           slot(-1, 1), slot(-1, 0), slot(0, -1), slot(1, -1)};

/// The slots of the control points beyond the ring: the last 7 of the K = 2N + 8 control points of
/// Stam 1998, or as many of them as the sides of the face leave (Lacewell & Burley 2007, section
/// 2).
constexpr int kOuter = 7;
constexpr std::array<int, kOuter> kOuterSlots = {slot(2, -1), slot(2, 0), slot(2, 1), slot(2, 2),
                                                 slot(1, 2),  slot(0, 2), slot(-1, 2)};

/// Whether the slot has a point. Slots beyond a boundary side have none.
constexpr bool exists(Sides sides, int c) {
  const bool below = yOf(c) < 0, before = xOf(c) < 0;
  if (below && before) {
    return false;
  }
  return !(below && onLeft(sides)) && !(before && onRight(sides));
}

constexpr bool isRingSlot(int c) { return xOf(c) <= 1 && yOf(c) <= 1; }

}  // namespace tile_grid

/// The part of one subdivision step to which no extraordinary rule applies: the 16 slots with x or
/// y above 1 after the step, from the 15 slots before it. These are the blocks S11 and S12 of A and
/// the additional rows of Abar (Lacewell & Burley 2007, section 2).
template <typename Real>
class TileStep {
 public:
  explicit TileStep(Sides sides) : sides_(sides) {
    using namespace tile_grid;
    for (int c = 0; c < kSlots; ++c) {
      if (!isRingSlot(c) && exists(sides, c)) {
        const std::vector<Term> terms = row(xOf(c), yOf(c));
        rows_.push_back({c, terms_.size(), terms_.size() + terms.size()});
        terms_.insert(terms_.end(), terms.begin(), terms.end());
      }
    }
  }

  struct Term {
    int slot;
    Real weight;
  };
  /// A slot after the step, and the range of its terms.
  struct Row {
    int slot;
    std::size_t first, end;
  };
  const std::vector<Row>& rows() const { return rows_; }
  const Term& term(std::size_t i) const { return terms_[i]; }

  /// Fills the slots of `next` that are none of the ring's from `values`. Both are indexed by slot;
  /// their elements are scalars or vectors.
  template <typename SlotValues, typename NextValues>
  void apply(const SlotValues& values, NextValues& next) const {
    for (const Row& r : rows_) {
      next[r.slot] = terms_[r.first].weight * values[terms_[r.first].slot];
      for (std::size_t i = r.first + 1; i < r.end; ++i) {
        next[r.slot] += terms_[i].weight * values[terms_[i].slot];
      }
    }
  }

 private:
  bool onBoundary(int x0, int y0, int x1, int y1) const {
    return (onLeft(sides_) && y0 == 0 && y1 == 0) || (onRight(sides_) && x0 == 0 && x1 == 0);
  }

  void addFace(std::vector<Term>& terms, int x, int y, Real weight) const {
    const Real each = weight * rules_.faceMask(4);
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      add(terms, x + dx, y + dy, each);
    }
  }

  void add(std::vector<Term>& terms, int x, int y, Real weight) const {
    const int c = tile_grid::slot(x, y);
    for (Term& term : terms) {
      if (term.slot == c) {
        term.weight += weight;
        return;
      }
    }
    terms.push_back({c, weight});
  }

  /// The terms of the new point at (x, y) of the finer grid, which is (x/2, y/2) of the coarser
  /// one.
  std::vector<Term> row(int x, int y) const {
    std::vector<Term> terms;
    const int x0 = (x - (x & 1)) / 2, y0 = (y - (y & 1)) / 2;
    if ((x & 1) && (y & 1)) {
      addFace(terms, x0, y0, 1);
    } else if ((x & 1) || (y & 1)) {
      const int x1 = x0 + (x & 1), y1 = y0 + (y & 1);
      const auto mask = rules_.edgeMask(onBoundary(x0, y0, x1, y1));
      add(terms, x0, y0, mask.vertices[0]);
      add(terms, x1, y1, mask.vertices[1]);
      if (mask.faces[0] != 0) {
        addFace(terms, x0 - (y & 1), y0 - (x & 1), mask.faces[0]);
        addFace(terms, x0, y0, mask.faces[1]);
      }
    } else if (onBoundary(x0 - 1, y0, x0, y0)) {
      addCrease(terms, x0, y0, 1, 0);
    } else if (onBoundary(x0, y0 - 1, x0, y0)) {
      addCrease(terms, x0, y0, 0, 1);
    } else {
      const auto mask = rules_.vertexMask(VertexRule::smooth, 4);
      add(terms, x0, y0, mask.vertex);
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
        add(terms, x0 + dx, y0 + dy, mask.edges[0]);
      }
      for (const auto& [dx, dy] : {std::pair{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}) {
        addFace(terms, x0 + dx, y0 + dy, mask.faces[0]);
      }
    }
    return terms;
  }

  void addCrease(std::vector<Term>& terms, int x, int y, int dx, int dy) const {
    const auto mask = rules_.vertexMask(VertexRule::crease, 3);
    add(terms, x, y, mask.vertex);
    add(terms, x + dx, y + dy, mask.edges.front());
    add(terms, x - dx, y - dy, mask.edges.back());
  }

  Sides sides_;
  SubdivisionRules<Real> rules_;
  std::vector<Row> rows_;
  std::vector<Term> terms_;
};

}  // namespace limitsurf
