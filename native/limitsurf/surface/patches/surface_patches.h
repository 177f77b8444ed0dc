// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/patches/core_normal.h"

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

/// A piece of the surface: a rectangle on which it is one bicubic patch, or a core. A core is a
/// square with an extraordinary vertex at (0, 0), on which the surface is a sequence of infinitely
/// many patches.
struct SurfacePiece {
  int tile = -1;
  std::int16_t steps = 0;  ///< the number of subdivisions around the extraordinary vertex, if any
  std::int16_t part = 0;   ///< which of the tile's patches after these, or kCore

  static constexpr std::int16_t kCore = -1;
  bool isCore() const { return part == kCore; }
  friend bool operator==(const SurfacePiece& a, const SurfacePiece& b) {
    return a.tile == b.tile && a.steps == b.steps && a.part == b.part;
  }
};

/// A box with axes of its own around the surface on a core.
struct CoreHull {
  Vector3 vertex;        ///< the limit of the core's vertex
  Eigen::Matrix3d axes;  ///< a unit vector in each row; the last is nearly normal to the surface
  Vector3 low, high;     ///< along the axes, relative to the vertex

  /// One of the eight corners, along the axes and relative to the vertex.
  Vector3 corner(int i) const {
    return {(i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]};
  }
};

/// The unit of length of patches.
enum class PatchUnit {
  coordinates,  ///< that of the control points
  /// The largest power of two that is no longer than the diagonal of the control points' bounding
  /// box, so that products of lengths neither overflow nor underflow. All digits stay the same.
  own
};

/// The limit surface in its present pose as bicubic patches, for searches and integrals.
///
/// A face without extraordinary vertices is one patch, or a few strips along a semi-sharp edge. A
/// face with extraordinary vertices is split into tiles with at most one of them, which are cores.
/// A core consists of three patches and a core of half its size. Searches split cores as often as
/// they need to; the patches are computed anew each time.
///
/// Refers to the surface or the data, which must live on and keep their pose. All members may be
/// called from many threads at once. Memory: 60 bytes for each tile; 900 bytes for each face around
/// an extraordinary vertex, or 4,800 if there are more than kFewFaces of them.
class SurfacePatches {
 public:
  /// The most steps of a core. A step shrinks a core's points by the largest eigenvalue below 1,
  /// which is at most (3 + sqrt 5) / 8 = 0.6545 for all rings with closed forms; 0.6545^72 = 6e-14,
  /// so that the rest of the core is within kPositionError of its vertex.
  static constexpr int kMostSteps = 72;
  /// Around vertices with more faces than this, the ring's points are kept for all steps.
  static constexpr int kFewFaces = 16;

  explicit SurfacePatches(const LimitSurface& surface, int threads = 0,
                          PatchUnit unit = PatchUnit::coordinates);
  /// Three columns of data, as if they were positions: `first_column`, a multiple of three, and the
  /// next two. Missing columns are 0.
  explicit SurfacePatches(const SurfaceData& data, int threads = 0, Eigen::Index first_column = 0,
                          PatchUnit unit = PatchUnit::coordinates);
  ~SurfacePatches();
  SurfacePatches(SurfacePatches&&) noexcept;
  SurfacePatches& operator=(SurfacePatches&&) noexcept;

  /// The number of tiles. They are in the order of their Ptex faces.
  int tileCount() const;
  /// Appends the pieces of a tile: its patches, or the one core that it is.
  void appendPieces(int tile, std::vector<SurfacePiece>& pieces) const;
  /// The number of these pieces.
  int pieceCount(int tile) const;

  FaceRectangle rectangle(const SurfacePiece& piece) const;

  /// The patch of a piece that is no core. Its points are exact to kPositionError / 10.
  BezierPatch patch(const SurfacePiece& piece) const;

  /// The parts of a core.
  struct SplitCore {
    BezierPatch patches[3];  ///< at (1/2, 0), (1/2, 1/2) and (0, 1/2) of the core
    SurfacePiece pieces[3];  ///< of these patches
    SurfacePiece core;       ///< the rest: the core of half the size
    Box core_box;            ///< a box around the rest

   private:
    friend class SurfacePatches;
    BezierPatch::Point grid_[25];  ///< the control points from which the rest can be split
  };
  /// Cost: O(1) for the first few steps, then O(valence) for valences to kFewFaces; for larger ones
  /// O(1) if `out` holds the split of which `core` is the rest.
  void split(const SurfacePiece& core, SplitCore& out) const;
  /// The same, but sets neither `core_box` nor where on the face the patches are.
  void splitPatches(const SurfacePiece& core, SplitCore& out) const;

  /// A box around the rest of a split. Its axes are those of the ring, so that it is as flat as the
  /// ring is, whichever way the surface lies.
  CoreHull restHull(const SplitCore& split) const;

  /// Appends points, relative to nothing, in whose convex hull the rest of a split lies: those of
  /// the ring and the outer ones of the grid. Cost: O(valence).
  void appendRestPoints(const SplitCore& split, std::vector<Padded>& points) const;

  /// A box around the surface on a tile's whole core (steps = 0).
  Box coreBox(const SurfacePiece& core) const;
  /// The largest distance of the ring's points from the core's vertex after the core's steps.
  double coreRadius(const SurfacePiece& core) const;
  /// The number of faces around the core's vertex.
  int coreValence(const SurfacePiece& core) const;
  /// Whether the core's vertex lies on a boundary or a crease that is a smooth curve there.
  bool isOnBoundaryCurve(const SurfacePiece& core) const;
  /// The largest difference, coordinate by coordinate, of two neighbours among those of the ring's
  /// points that belong to the core after its steps, in a frame (a rotation, whose rows are axes).
  /// Beyond the steps for which points are kept it is a bound, larger by some factor.
  Vector3 ringPitch(const SurfacePiece& core, const Eigen::Matrix3d& frame) const;
  /// The same of two neighbours among the control points from which the rest can be split, at least
  /// one of which is none of the ring's.
  Vector3 outerPitch(const SplitCore& split, const Eigen::Matrix3d& frame) const;
  /// A frame for ringPitch(), in which the core is about as long as wide: its first axis runs
  /// between the sides of the core, the last one across both.
  Eigen::Matrix3d coreFrame(const SurfacePiece& core) const;
  /// The number of extraordinary vertices; each has a ring of faces.
  int ringCount() const;
  /// The ring to which a core belongs, and which of its faces the core is on.
  int ringOf(const SurfacePiece& core) const;
  int ringFace(const SurfacePiece& core) const;
  /// By how many subdivisions of the ring's first points the core is reached. The cores of one ring
  /// at the same level are next to each other.
  int ringLevel(const SurfacePiece& core) const;
  /// Axes of the ring, an axis in each row. The last is nearly normal to the surface.
  Eigen::Matrix3d ringFrame(int ring) const;
  /// How far the surface on the cores of a ring, at one level, is from having the symmetry of a
  /// regular polygon around the last axis of its frame, that is, the largest distance between
  /// points that ought to coincide. Infinity if the faces do not go all around the vertex, if
  /// `cores` are not all of the ring's, or if it is not less than `enough`.
  double ringAsymmetry(const std::vector<SurfacePiece>& cores, double enough) const;

  /// What the points of a core are a function of: its ring, and which of the ring's faces it is on.
  /// All faces are face 0 if a turn by one face maps the ring onto itself.
  using CoreKind = std::pair<const Eigenbasis*, int>;
  CoreKind coreKind(const SurfacePiece& core) const;
  /// The number of cores of each kind around vertices with at most kFewFaces.
  std::map<CoreKind, int> coreKinds() const;
  static constexpr int kMostCorePoints = 2 * kFewFaces + 2 + tile_grid::kOuter;
  /// The points of a whole core (steps = 0), at most kFewFaces of whose kind: those of its ring,
  /// turned to the face of its kind, and then the outer points, relative to the core's vertex.
  /// Returns false if they are not kept.
  bool corePoints(const SurfacePiece& core, Padded points[kMostCorePoints]) const;

  /// Makes coreNormal() known for the kinds of cores that the surface has many of.
  void prepareCoreNormals();
  /// The integral of ds x dt over a whole core (steps = 0). Returns false if it is not known, or if
  /// the control points of some step show that the surface may turn over close to the vertex, where
  /// this integral tells nothing of the area: if the quad of them at the vertex is turned over, or
  /// if after many steps its direction still differs by a large angle from the integral's.
  bool coreNormal(const SurfacePiece& core, CoreNormal::Value& out) const;

  /// The limit position of the core's vertex.
  Vector3 coreVertex(const SurfacePiece& core) const;

  /// Diagonal of the control points' bounding box: the unit of kPositionError.
  double diagonal() const;
  /// The middle of that box.
  Vector3 middle() const;

  /// What coordinates were multiplied by: a power of two. All lengths here are multiples of its
  /// inverse.
  double scale() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
