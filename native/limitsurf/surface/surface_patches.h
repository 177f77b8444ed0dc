// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// An axis-aligned box; empty when made.
struct Box {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = Vector3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vector3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void include(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
};

/// A piece of the surface: a rectangle on which it is one bicubic patch, or a core, a square with
/// an extraordinary vertex at (0, 0) on which it is infinitely many.
struct SurfacePiece {
  int tile = -1;
  std::int16_t steps = 0;  ///< subdivisions around the extraordinary vertex, if there is one
  std::int16_t part = 0;   ///< which of the tile's patches after so many, or kCore

  static constexpr std::int16_t kCore = -1;
  bool isCore() const { return part == kCore; }
};

/// The limit surface in its present pose as bicubic patches: everything that a search needs to know
/// about it.
///
/// A face without extraordinary vertices is one patch, or a few strips along a semi-sharp edge. One
/// with them is split into tiles with one such vertex at most, and a core at each, which is three
/// patches and a core of half its size, as often as the search asks; nothing is kept of those.
///
/// Refers to the surface or data, which must live on and keep their pose. All members may be called
/// from many threads at once. Memory: 60 bytes a tile; around an extraordinary vertex 800 bytes a
/// face, with more than kFewFaces of them 4,600.
class SurfacePatches {
 public:
  /// After so many steps, and with so small a core that positions in it are kPositionError from
  /// the vertex, it need not be split any more.
  static constexpr int kMostSteps = 72;
  static constexpr int kFewFaces = 16;

  explicit SurfacePatches(const LimitSurface& surface, int threads = 0);
  /// Of data's first three columns, as if they were positions; what columns are missing is 0.
  explicit SurfacePatches(const SurfaceData& data, int threads = 0);
  ~SurfacePatches();
  SurfacePatches(SurfacePatches&&) noexcept;
  SurfacePatches& operator=(SurfacePatches&&) noexcept;

  /// Tiles, in the order of their Ptex faces.
  int tileCount() const;
  /// What a tile consists of: patches, or the core of all of it.
  void appendPieces(int tile, std::vector<SurfacePiece>& pieces) const;
  /// How many.
  int pieceCount(int tile) const;

  FaceRectangle rectangle(const SurfacePiece& piece) const;

  /// The patch of a piece that is no core. Its points are the surface's to kPositionError / 10.
  BezierPatch patch(const SurfacePiece& piece) const;

  /// A core one step later.
  struct SplitCore {
    BezierPatch patches[3];  ///< at (1/2, 0), (1/2, 1/2) and (0, 1/2) of the core
    SurfacePiece pieces[3];  ///< the same
    SurfacePiece core;       ///< the rest
    Box core_box;            ///< around the rest

   private:
    friend class SurfacePatches;
    BezierPatch::Point grid_[25];  ///< the control points that the rest is split from
  };
  /// Cost: O(1) for the first few steps, then O(valence) for valences to kFewFaces; with more faces
  /// O(1) where `out` holds the split that `core` came from.
  void split(const SurfacePiece& core, SplitCore& out) const;

  /// A box around the surface on a tile's whole core (steps = 0).
  Box coreBox(const SurfacePiece& core) const;
  /// The largest distance between the core's vertex and the points around it that decide about the
  /// surface there, up to the core's own corner points: what is left of the core beyond `steps`.
  double coreRadius(const SurfacePiece& core) const;
  /// The limit position of the core's vertex.
  Vector3 coreVertex(const SurfacePiece& core) const;

  /// Diagonal of the control points' bounding box: the unit of kPositionError.
  double diagonal() const;
  /// The middle of that box.
  Vector3 middle() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
