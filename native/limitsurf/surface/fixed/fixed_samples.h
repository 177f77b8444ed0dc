// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Locations that stay the same while the control mesh deforms: positions and first derivatives
/// there are computed from the control points of one frame after another, without posing a surface.
/// This is what OpenSubdiv's LimitStencilTable is for, but exact.
///
/// With one sample on each Ptex face, it takes half of the time of LimitSurface::setPositions() and
/// evaluate() on regular quads, and about a fiftieth on triangles: it computes only what the
/// samples depend on. With a hundred samples on each regular quad, evaluate() is as fast.
///
/// On a quad whose vertices are all regular a sample keeps its parameters, and elsewhere the
/// weights of the vertices that it depends on. A sample that depends on more than kMostWeights
/// vertices, near a vertex of many faces or near the middle of a face of many sides, does without
/// them: what it shares with other samples there is computed once a frame.
///
/// It refers to the topology of the surface, which it keeps alive, but not to its pose: it may
/// outlive the surface, and be used while the surface is posed. All const members may be called
/// from many threads at once.
///
/// Memory: 24 bytes a sample on such quads. Elsewhere 12 bytes, and for each vertex that the sample
/// depends on 12 more, or 28 with derivatives: on triangles 160 or 360 bytes, near vertices of many
/// faces up to 800 or 1,800. From the first evaluate() on, 32 bytes for each vertex are kept.
class FixedSamples {
 public:
  static constexpr std::size_t kMostWeights = 64;

  /// `derivatives` says what evaluate() computes: none or first. Throws the errors of
  /// LimitSurface::evaluate() for the locations, and std::invalid_argument for second derivatives
  /// and for 2^32 locations or more. Cost: that of LimitSurface::stencils() where samples have
  /// weights; O(1) elsewhere.
  FixedSamples(const LimitSurface& surface, const LocationBatch& at,
               Derivatives derivatives = Derivatives::none, int threads = 0);
  ~FixedSamples();
  FixedSamples(FixedSamples&&) noexcept;
  FixedSamples& operator=(FixedSamples&&) noexcept;

  /// The number of samples, what is computed there, and the number of the control mesh's vertices.
  std::size_t size() const;
  Derivatives derivatives() const;
  int vertexCount() const;
  /// What the samples take, without the topology and what evaluate() keeps.
  std::size_t bytes() const;

  /// Positions, and du and dv if they were asked for, on the surface with these control points, one
  /// for each vertex. The results have the error bounds of LimitSurface::evaluate(), and are NaN
  /// where its results are. They depend neither on the number of threads nor on other samples.
  /// Positions with and without derivatives may differ in their last bits. Other arrays are
  /// ignored.
  ///
  /// Throws MeshError for control points as LimitSurface::setPositions() does, and
  /// std::invalid_argument for arrays of other sizes; nothing is written then. Where a call is
  /// interrupted, some rows are written. Cost: O(vertices), and a sum of the vertices that a sample
  /// depends on, 10 to 35 ns on one thread. If a sample depends on more than kMostWeights vertices,
  /// a call also looks at each irregular face, which takes about two nanoseconds.
  template <typename Real>
  void evaluate(const RowsIn<Points>& control_points, const EvaluationArrays<Real>& results,
                int threads = 0) const;
  Evaluation evaluate(const RowsIn<Points>& control_points, int threads = 0) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
