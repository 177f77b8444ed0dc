// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/project/projection.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/uv/texel_places.h"

namespace limitsurf {

/// The part of each texel that is visible from a projector's eye, by the rays of project().
class Visibility {
 public:
  /// Keeps references to all arguments.
  Visibility(const LimitSurface& surface, const Projector& projector, const SurfaceSearch& occluder,
             const ProjectOptions& options, int threads);

  /// Multiplies each weight by the part of the texel's samples that are visible. Texels of weight 0
  /// are not tested.
  void apply(const LocationBatch& at, const TexelPlaces& places, Eigen::VectorXd& weight) const;

 private:
  /// Evaluates the samples of the texels in these rows: a square grid over each.
  void evaluateSamples(const LocationBatch& at, const TexelPlaces& places,
                       const std::vector<Eigen::Index>& rows, Points& position,
                       Points& normal) const;
  /// For each sample whether it is visible.
  std::vector<char> areSeen(const Points& position, const Points& normal) const;

  const LimitSurface& surface_;
  const Projector& projector_;
  const SurfaceSearch& occluder_;
  const ProjectOptions& options_;
  int threads_;
  double bias_;
};

}  // namespace limitsurf
