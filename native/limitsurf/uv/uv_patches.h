// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/surface/surface_patches.h"
#include "limitsurf/uv/uv_inverse.h"

namespace limitsurf {

/// A piece of a UV map, and a box around its image.
struct UvPiece {
  SurfacePiece piece;
  Box2 box;
};

/// A UV map as bicubic patches.
class UvPatches {
 public:
  /// Throws std::invalid_argument for data of other than two columns, and for values whose products
  /// would overflow. Refers to the map.
  explicit UvPatches(const SurfaceData& map, int threads);

  const std::vector<UvPiece>& pieces() const { return pieces_; }
  const SurfacePatches& patches() const { return patches_; }
  /// The diagonal of the box around the map's values and (0, 0).
  double extent() const { return extent_; }
  /// What searches leave undone, in map coordinates.
  double tolerance() const { return kTolerance * extent_; }

  /// A rectangle of a Ptex face, and what is found on it.
  class Sink : public FindSink {
   public:
    /// Called before finds on another rectangle.
    virtual void enter(const FaceRectangle& on) = 0;
  };
  /// Tells `sink` of all places on the piece that lie in lattice points.
  void invert(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
              Sink& sink) const;

 private:
  static constexpr double kTolerance = 1e-13;

  void invertCore(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
                  Sink& sink) const;

  SurfacePatches patches_;
  std::vector<UvPiece> pieces_;
  double extent_;
};

/// The patch in the coordinates of a lattice.
UvCell cellOf(const BezierPatch& patch, const PlaneFrame& frame);

}  // namespace limitsurf
