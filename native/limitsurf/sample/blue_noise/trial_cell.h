// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/random_bits.h"
#include "limitsurf/sample/blue_noise/noise_kernels.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A part of the surface in which there may still be room for a point: a dyadic rectangle of a
/// patch's parameters, or a core. Each round makes one trial in it, a random candidate.
struct TrialCell {
  SurfacePiece piece;
  std::uint32_t column = 0, row = 0;  ///< of 2^level each
  std::uint8_t s_level = 0, t_level = 0;

  static constexpr int kMostLevels = 31;

  double width() const { return 1. / (std::uint32_t{1} << s_level); }
  double height() const { return 1. / (std::uint32_t{1} << t_level); }

  /// Whether it is on an earlier patch: tile by tile, and from the outside of a core inwards.
  bool comesBefore(const TrialCell& other) const {
    const SurfacePiece &a = piece, &b = other.piece;
    return a.tile != b.tile ? a.tile < b.tile
           : a.steps != b.steps
               ? a.steps < b.steps
               : static_cast<std::uint16_t>(a.part) < static_cast<std::uint16_t>(b.part);
  }

  /// The lower (0) or upper (1) half along s, and along t.
  TrialCell halfOfS(unsigned which) const {
    TrialCell half = *this;
    ++half.s_level;
    half.column = 2 * column + which;
    return half;
  }
  TrialCell halfOfT(unsigned which) const {
    TrialCell half = *this;
    ++half.t_level;
    half.row = 2 * row + which;
    return half;
  }

  /// Puts the cell's middle and its size into a block.
  void putMiddle(ExtentBlock& block, int place) const {
    const double a = block.half_width[place] = width() / 2;
    const double b = block.half_height[place] = height() / 2;
    block.s[place] = (2. * column + 1) * a;
    block.t[place] = (2. * row + 1) * b;
  }

  /// A key of random bits for all cells of the piece.
  std::uint64_t pieceKey(std::uint64_t key) const {
    const std::uint32_t part =
        static_cast<std::uint32_t>(piece.steps) << 16 | static_cast<std::uint16_t>(piece.part);
    return mixed(key ^ mixed(joined(static_cast<std::uint32_t>(piece.tile), part)));
  }
  /// Random bits that no other cell has under the same key, which is that of the piece.
  std::uint64_t bits(std::uint64_t piece_key) const {
    return mixed(mixed(piece_key ^ mixed(joined(column, row))) ^
                 static_cast<std::uint64_t>(s_level << 8 | t_level));
  }

 private:
  static std::uint64_t joined(std::uint64_t high, std::uint32_t low) { return high << 32 | low; }
};

}  // namespace limitsurf
