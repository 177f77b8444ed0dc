// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Data on a limit surface, of any number of columns, evaluated exactly at any location: made by
/// LimitSurface::faceVarying(), vertexData() and varying(). It does not depend on the surface's
/// positions, and may outlive the surface.
///
/// All const members may be called from many threads at once.
///
/// Memory: as a surface's pose, for every three columns; face-varying and varying data have tiles
/// of their own besides.
class SurfaceData {
 public:
  ~SurfaceData();
  SurfaceData(SurfaceData&&) noexcept;
  SurfaceData& operator=(SurfaceData&&) noexcept;

  /// Number of Ptex faces, the surface's.
  int faceCount() const;
  /// Rows and columns of the values that it was made of.
  Eigen::Index rows() const;
  Eigen::Index columns() const;

  /// Other values in the same places. Throws MeshError for another number of rows or columns and
  /// naming the first row that is not finite, and then leaves the data as they were. Not to be
  /// called while another thread evaluates. Cost: as LimitSurface::setPositions(), for every three
  /// columns.
  void setValues(const DataRows& values, int threads = 0);

  /// Throws what evaluate() throws for the first row that cannot be evaluated, and does nothing
  /// else.
  void checkLocations(Span<Location> at) const;

  /// Data and derivatives with respect to the face's own (u, v), with the error bounds of
  /// LimitSurface::evaluate(), relative to the diagonal of the values' bounding box.
  ///
  /// Exactly at a vertex where the data's own neighbourhood is irregular, derivatives are those
  /// that LimitSurface::evaluate() would give there: NaN where there is no limit.
  ///
  /// Throws as LimitSurface::evaluate(). Cost: as that, for every three columns.
  DataEvaluation evaluate(Span<Location> at, Derivatives derivatives = Derivatives::none,
                          int threads = 0) const;

 private:
  friend class LimitSurface;
  friend class SurfacePatches;
  struct Data;
  explicit SurfaceData(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
