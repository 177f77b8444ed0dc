// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// How densely a surface is to be covered, here against there. Weights are relative: doubling all
/// changes nothing. Where they are 0 there is nothing.
class Density {
 public:
  /// Weights of a batch of locations. Called on the thread that asked for samples.
  using Function = std::function<void(Span<Location> at, double* weights)>;

  /// The same everywhere.
  Density() = default;

  /// By any function of the location.
  explicit Density(Function function) : function_(std::move(function)) {}

  /// A weight for each vertex of the control mesh, linear along edges and bilinear on each Ptex
  /// face, as LimitSurface::varying() has it. Throws std::invalid_argument for another number of
  /// weights and naming the first that is negative or not finite.
  Density(const LimitSurface& surface, const Eigen::VectorXd& weights, int threads = 0);

  bool isConstant() const { return !function_ && corners_.empty(); }
  /// None where the weights are the vertices'.
  const Function& function() const { return function_; }
  /// Of vertices' weights: those of each Ptex face at (0, 0), (1, 0), (0, 1) and (1, 1).
  const std::vector<double>& corners() const { return corners_; }

  /// The function's weights; std::invalid_argument naming the first location at which it is
  /// negative or not finite.
  std::vector<double> weights(Span<Location> at) const;

 private:
  Function function_;
  std::vector<double> corners_;
};

}  // namespace limitsurf
