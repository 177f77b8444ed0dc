// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "limitsurf/mesh/interpolation.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Values of data and derivatives, one row per location in the caller's order. Members that were
/// not asked for have no rows.
struct DataEvaluation {
  DataRows value, du, dv, duu, duv, dvv;
};

/// The caller's own memory for an evaluation of data: contiguous rows, one for each location, of as
/// many numbers as the data have columns. Float results are the double ones, rounded.
template <typename Real>
struct DataArrays {
  struct Rows {
    Real* numbers = nullptr;
    std::size_t count = 0;
  };
  Rows value = {}, du = {}, dv = {}, duu = {}, duv = {}, dvv = {};
};

/// Boxes around data on side x side equal squares of each Ptex face: the row
/// (face * side + row) * side + column holds the lower and the upper bounds of all columns on one
/// square; u increases with the column. On faces that have no surface all are NaN.
struct DataBounds {
  DataRows low, high;
};

/// The boxes of SurfaceData::bounds() are wider by this on each side, as a part of the diagonal of
/// the box around three columns of the values: kPositionError for what evaluate() returns, and a
/// quarter of it for the error of the boxes themselves. Four units of rounding of the box's largest
/// number are added. Where all control values are 0 the box is exactly 0.
constexpr double kBoundsPadding = 1.25 * kPositionError;

/// Data of any number of columns on a limit surface, evaluated exactly at any location.
/// LimitSurface::faceVarying(), vertexData() and varying() make it. It does not depend on the
/// surface's positions, and may outlive the surface.
///
/// All const members may be called from many threads at once.
///
/// Memory: that of a surface's pose for every three columns; face-varying and varying data also
/// have tiles of their own.
class SurfaceData {
 public:
  ~SurfaceData();
  SurfaceData(SurfaceData&&) noexcept;
  SurfaceData& operator=(SurfaceData&&) noexcept;

  /// The number of Ptex faces, which is the surface's.
  int faceCount() const;
  /// The numbers of rows and columns of the values.
  Eigen::Index rows() const;
  Eigen::Index columns() const;

  /// Replaces the values. Throws MeshError for another number of rows or columns, and for the first
  /// row that is not finite or beyond kLargestCoordinate, which it names, and then leaves the data
  /// as they were. Must not be called while another thread evaluates. Cost: that of
  /// LimitSurface::setPositions() for every three columns. If an InterruptionPoint ends it, isSet()
  /// is false until values are set again, and nothing may be evaluated before.
  void setValues(const DataRows& values, int threads = 0);
  bool isSet() const;

  /// Checks a batch, as LimitSurface::checkLocations() does.
  LocationBatch checkLocations(const LocationBatch& at, int threads = 0) const;

  /// Data and derivatives with respect to the face's own (u, v), with the error bounds of
  /// LimitSurface::evaluate(), relative to the diagonal of the values' bounding box.
  ///
  /// Exactly at a vertex where the data's own neighbourhood is irregular, derivatives are those
  /// that LimitSurface::evaluate() would give there: NaN where there is no limit.
  ///
  /// Throws what LimitSurface::evaluate() throws. Cost: that of LimitSurface::evaluate() for every
  /// three columns.
  DataEvaluation evaluate(const LocationBatch& at, Derivatives derivatives = Derivatives::none,
                          int threads = 0) const;
  /// The same into the caller's memory. Throws std::invalid_argument for arrays with another number
  /// of rows. Real is double or float.
  template <typename Real>
  void evaluate(const LocationBatch& at, Derivatives derivatives, const DataArrays<Real>& results,
                int threads = 0) const;

  /// Boxes that hold all values which evaluate() returns on squares of the faces, borders included.
  /// They are the boxes of Bezier control points: exact for bilinear data but for kBoundsPadding,
  /// and for smooth data wider than the values by an amount that shrinks with the square of `side`.
  ///
  /// Throws std::invalid_argument for a `side` below 1 or above kMostBoundsSide, and for more boxes
  /// than memory can hold. Cost: O(faces * side^2 * columns), about 0.3 microseconds for three
  /// columns of a square.
  DataBounds bounds(int side = 1, int threads = 0) const;
  static constexpr int kMostBoundsSide = 1024;

 private:
  friend class LimitSurface;
  friend class SurfacePatches;
  struct Data;
  explicit SurfaceData(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
