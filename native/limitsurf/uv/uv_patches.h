// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/uv/uv_inverse.h"

namespace limitsurf {

/// A piece of a UV map, and a box around its image.
struct UvPiece {
  SurfacePiece piece;
  Box2 box;
};

/// A UV map as bicubic patches and cores.
class UvPatches {
 public:
  /// Refers to the map. Throws std::invalid_argument if the data have other than two columns, and
  /// for values whose products would overflow.
  explicit UvPatches(const SurfaceData& map, int threads);

  const std::vector<UvPiece>& pieces() const { return pieces_; }
  const SurfacePatches& patches() const { return patches_; }
  /// The diagonal of the box around the map's values and (0, 0).
  double extent() const { return extent_; }
  /// The error that inversions may leave, in map coordinates.
  double tolerance() const { return kTolerance * extent_; }

  /// A receiver of finds that is told the rectangle of the Ptex face on which they lie.
  class Sink : public FindSink {
   public:
    /// Called before finds on another rectangle.
    virtual void enter(const FaceRectangle& on) = 0;
  };
  /// Reports to `sink` all places of the piece that the map takes to lattice points.
  void invert(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
              Sink& sink) const;

 private:
  /// A tenth of kMapError.
  static constexpr double kTolerance = 1e-13;

  void invertCore(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
                  Sink& sink) const;

  /// Reports the vertex of a core as a find. Its wedges lie between the corners of the three
  /// patches of the last possible split: all faces around the vertex must take the same number of
  /// steps, since directions may converge slowly.
  void addVertex(SurfacePiece core, SurfacePatches::SplitCore& split, bool flipped,
                 const PlaneFrame& frame, const Lattice& inside, Sink& sink) const;

  SurfacePatches patches_;
  std::vector<UvPiece> pieces_;
  double extent_;
};

/// A whole patch as a cell, in the coordinates of a lattice.
UvCell cellOf(const BezierPatch& patch, const PlaneFrame& frame);

}  // namespace limitsurf
