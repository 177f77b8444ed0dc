// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// How the tangents of a core turn into the tangent plane of its vertex, step by step.
///
/// The differences of the control points of a core's patches are sums of modes (Stam). Two modes,
/// with the same eigenvalue, shrink the slowest: they span the tangent plane, and their share is
/// known exactly. All others together are a linear function of what these two leave over of the
/// core's points, whose weights fall with each step.
class CoreTangents {
 public:
  /// The number of steps for which a bound is kept.
  static constexpr int kSteps = 24;

  /// O(valence^3).
  CoreTangents(const Eigenbasis& basis, int face);

  /// Normals of the patches beside a core. Refers to the CoreTangents.
  class Settling {
   public:
    /// That of the tangent plane, with unit length.
    const Vector3& normal() const { return normal_; }
    /// The tangent of the largest angle between that normal and those of all patches that follow
    /// after n steps; infinity if nothing is known, as after kSteps and more. O(valence).
    double slopeAfter(int steps) const;

   private:
    friend class CoreTangents;

    const CoreTangents* tangents_ = nullptr;
    Vector3 normal_;
    double area_, longest_;  // of the parallelogram of the two modes, and of the tangents
    // What the two modes leave over of each point: within their plane, and off it.
    double within_[SurfacePatches::kMostCorePoints], off_[SurfacePatches::kMostCorePoints];
  };
  /// From the points as SurfacePatches::corePoints() gives them. Returns false if nothing is known:
  /// where other modes than two span the tangent plane, or where they span none. O(valence).
  bool settle(const Padded points[], Settling& out) const;

 private:
  std::size_t size_ = 0;  ///< the number of points; 0 if nothing is known
  /// Of each point, its weights in the two modes, and the modes at the point.
  std::vector<Eigen::Array2d> weights_, modes_;
  /// Tangents are sums of the two modes: the greatest length of the pair of factors, and the least
  /// coefficient of the Jacobian determinant.
  double longest_ = 0, least_area_ = 0;
  std::vector<double> others_;  ///< bounds on the weights of the points in all other modes
};

}  // namespace limitsurf
