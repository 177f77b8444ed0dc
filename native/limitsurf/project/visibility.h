// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/project/projection.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/uv/texel_places.h"

namespace limitsurf {

/// Which part of a texel can be seen from a projector's eye: project()'s rays.
class Visibility {
 public:
  /// Refers to all of them.
  Visibility(const LimitSurface& surface, const Projector& projector, const SurfaceSearch& occluder,
             const ProjectOptions& options, int threads);

  /// Multiplies each weight by the part of the texel's samples that are seen. Texels without weight
  /// cost nothing.
  void apply(Span<Location> at, const TexelPlaces& places, Eigen::VectorXd& weight) const;

 private:
  void evaluateSamples(Span<Location> at, const TexelPlaces& places,
                       const std::vector<Eigen::Index>& rows, Points& position,
                       Points& normal) const;
  std::vector<char> areSeen(const Points& position, const Points& normal) const;

  const LimitSurface& surface_;
  const Projector& projector_;
  const SurfaceSearch& occluder_;
  const ProjectOptions& options_;
  int threads_;
  double bias_;
};

}  // namespace limitsurf
