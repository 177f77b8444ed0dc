// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// One quaternion w, x, y, z per row, in single precision.
using FloatRotations = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// Bound on the error of posed points before they are rounded to float: relative to the diagonal of
/// the control mesh's bounding box, as `to_strands` carries it, plus the distance of the point from
/// its strand's root. It is the sum of kPositionError and of a rotation's error, which is
/// kNormalError for each of the normal and the tangent. As that one, it holds for meshes that are
/// not far from the origin: docs/accuracy.md, "Normals".
constexpr double kStrandError = 4e-11;

/// Strands that are bound to locations on a limit surface, and are carried along when the surface
/// is posed: hair, or, as strands of one point each, scattered points and instances.
///
/// Each strand was bound at a location where the surface had, at rest, the position r and the frame
/// R, as LimitSurface::frames() gives it. Where the surface now has P and F there, the strand moves
/// as a rigid body with its root: a point p of the rest shape goes to
///
///   P + F R^-1 (p - r).
///
/// r and R are given in the space of the strands. `to_strands` leads from the surface's space to
/// it: P is carried as a point, and F is made of the carried du, the normal of the carried surface
/// (on the side to which the surface's normal is carried) and normal x tangent. F is thus a
/// rotation whatever the matrix is, and strands stay outside where a matrix mirrors. Where du or
/// the normal has no limit or vanishes, F is made in the same way of the columns of frames().
///
/// What depends on the locations alone is prepared once. The surface may be posed between the
/// calls. It is referred to and must live on. Strands whose neighbours in the batch lie on the same
/// face are posed faster than strands in random order.
///
/// A strand whose rest rotation is (0, 0, 0, 0) is not bound: it stays where it is, and its
/// location and its rest root are not looked at. So attributes that a new strand does not have yet
/// may be 0.
///
/// Every call takes `threads` as LimitSurface's do, and the number gives the same bits. If a call
/// is interrupted, some rows of its output are written and others are not. Input and output may be
/// the same array. Points that are not finite give points that are not finite.
class StrandPoser {
 public:
  /// `offsets` holds n + 1 numbers for n locations: strand i consists of the points offsets[i] to
  /// offsets[i + 1] - 1. If it is empty each strand has one point.
  ///
  /// Throws the errors of LimitSurface::evaluate() for the locations of bound strands;
  /// std::invalid_argument for other numbers of rows, for offsets that do not begin with 0 or that
  /// decrease, and for a rest root or rest rotation of a bound strand that is not finite, which it
  /// names with its row. Rotations need not have the length 1.
  StrandPoser(const LimitSurface& surface, Span<Location> at, const RowsIn<FloatPoints>& rest_roots,
              const RowsIn<FloatRotations>& rest_rotations,
              const std::vector<std::int64_t>& offsets = {}, int threads = 0);
  ~StrandPoser();
  StrandPoser(StrandPoser&&) noexcept;
  StrandPoser& operator=(StrandPoser&&) noexcept;

  /// The numbers of strands, of those that are bound, and of points.
  std::size_t size() const;
  std::size_t boundCount() const;
  std::int64_t pointCount() const;
  /// The number of bound strands that calls with `control_points` move faster: at places that
  /// depend on at most FixedSamples::kMostWeights vertices, which are no plain grid. Strands that
  /// are nearer to an irregular vertex than 2^-8 of a face do not count. Cost: O(size()).
  std::size_t irregularCount() const;

  // The calls below throw std::invalid_argument for arrays of other sizes, and for a matrix that is
  // not finite or whose last row is not (0, 0, 0, 1). Cost: an evaluation with first derivatives
  // for each strand, and some nanoseconds for each point.
  //
  // They carry strands to the surface as it is posed; or, with `control_points`, one for each
  // vertex, to the surface with these. Its own pose is not looked at then, so that it need not be
  // posed for each frame. That saves half a microsecond to one for each of irregularCount(), and
  // costs up to 30 ns more for each other strand. The results may differ in their last bits. These
  // calls throw MeshError as LimitSurface::setPositions() does. The first one prepares what
  // FixedSamples have for the roots. On triangles that takes about 10 microseconds for each strand,
  // and 320 bytes, and twice the memory meanwhile. From then on 32 bytes for each vertex are kept.

  /// Moves the points of the rest shape to where they are on the surface. Error: kStrandError, and
  /// the rounding to float.
  void pose(const RowsIn<FloatPoints>& rest_points, RowsOut<FloatPoints> posed,
            const Eigen::Matrix4d& to_strands = Eigen::Matrix4d::Identity(), int threads = 0,
            const RowsIn<Points>* control_points = nullptr) const;

  /// What repose() tells about the points that it moved.
  struct Reposed {
    bool has_changed;                        // a bit of a point is not as it was before
    std::vector<std::int32_t> fingerprints;  // those of the new points
  };

  /// pose() and fingerprints() in one pass over points that hold an earlier pose. An application
  /// that stores the points can thus tell whether it has to store them again.
  Reposed repose(const RowsIn<FloatPoints>& rest_points, RowsOut<FloatPoints> points,
                 const Eigen::Matrix4d& to_strands = Eigen::Matrix4d::Identity(), int threads = 0,
                 const RowsIn<Points>* control_points = nullptr) const;

  /// The inverse: the rest shape of points that lie where the surface carries them. With `only`,
  /// one flag per strand, points of other strands are not written.
  void unpose(const RowsIn<FloatPoints>& points, RowsOut<FloatPoints> rest_points,
              const Eigen::Matrix4d& to_strands = Eigen::Matrix4d::Identity(),
              const std::vector<char>& only = {}, int threads = 0,
              const RowsIn<Points>* control_points = nullptr) const;

  /// Turns a vector at each point as pose() turns the strand.
  void poseVectors(const RowsIn<FloatPoints>& rest_vectors, RowsOut<FloatPoints> posed,
                   const Eigen::Matrix4d& to_strands = Eigen::Matrix4d::Identity(), int threads = 0,
                   const RowsIn<Points>* control_points = nullptr) const;

  /// Turns a rotation at each point as pose() turns the strand. The results have the length 1 and
  /// w >= 0, or are 0 where the given rotation is.
  void poseRotations(const RowsIn<FloatRotations>& rest_rotations, RowsOut<FloatRotations> posed,
                     const Eigen::Matrix4d& to_strands = Eigen::Matrix4d::Identity(),
                     int threads = 0, const RowsIn<Points>* control_points = nullptr) const;

  /// A number for each strand that depends on the bits of its points alone and is never 0. If one
  /// bit of a strand changes, so does its number, but for one case in 2^32. It tells strands that
  /// somebody has edited from those that are as they were written.
  std::vector<std::int32_t> fingerprints(const RowsIn<FloatPoints>& points, int threads = 0) const;

 private:
  struct Carrier;
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
