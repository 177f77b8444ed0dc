// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/sample/density_limits.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// How densely points are to cover a surface. Weights are relative: doubling all of them changes
/// nothing. No point lies where the weight is 0.
class Density {
 public:
  /// Writes the weights of a batch of locations. It is called on the thread that asked for samples.
  using Function = std::function<void(Span<Location> at, double* weights)>;

  /// The same weight everywhere.
  Density() = default;

  /// Any function of the location. Where it is small on most of the surface, limits that it never
  /// exceeds save most of the candidates of AreaSampler::uniform(). Where they are 0 blue noise
  /// does not read the function either.
  explicit Density(Function function, DensityLimits limits = {})
      : function_(std::move(function)), limits_(std::move(limits)) {}

  /// A weight for each vertex of the control mesh, interpolated linearly along edges and bilinearly
  /// on each Ptex face, as by LimitSurface::varying(). Throws std::invalid_argument if there are
  /// not as many weights as vertices, and naming the first weight that is negative or not finite.
  Density(const LimitSurface& surface, const Eigen::VectorXd& weights, int threads = 0);

  bool isConstant() const { return !function_ && corners_.empty(); }
  /// The function; empty if the weights are given at vertices.
  const Function& function() const { return function_; }
  /// What the function does not exceed.
  const DensityLimits& limits() const { return limits_; }
  /// Where weights are given at vertices: those of each Ptex face at (0, 0), (1, 0), (0, 1), (1,
  /// 1).
  const std::vector<double>& corners() const { return corners_; }

  /// The function's weights at the locations. Those below 0 by less than 1e-12 of the largest one
  /// count as 0: interpolated weights round. Throws std::invalid_argument naming the first location
  /// at which the function is less than that, not finite or above its limit.
  std::vector<double> weights(Span<Location> at) const;

 private:
  Function function_;
  DensityLimits limits_;
  std::vector<double> corners_;
};

/// The message for a density function that is 0 at all of `count` locations, or for one that need
/// not be called, since all its limits are 0.
std::string zeroEverywhereText(std::size_t count);

/// The message for a function of which none of `count` candidates in succession was accepted:
/// `largest` is the largest of their densities. `limit` is the largest limit, or 0 if there are
/// none.
std::string tooFewAcceptedText(std::size_t count, double largest, double limit);

}  // namespace limitsurf
